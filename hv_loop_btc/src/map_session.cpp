#include "hv_loop_btc/map_session.h"

#include "hv_core/error.h"
#include "hv_core/map_folder.h"
#include "hv_loop_btc/submap_file.h"
#include "required_parts.h"

namespace hv::loop {
namespace {

void AdoptKeyframes(const MapFolder& map, const PoseGraphData& graph, KeyframeStore& store) {
  for (const GraphVertex& vertex : graph.vertices) {
    map.ReadKeyframe(vertex.id);  // compares the checksum
    store.Adopt(vertex.id, map.path() + "/" + KeyframeFileName(vertex.id));
  }
}

void CheckReferences(const StoredSubmaps& submaps, const KeyframeStore& store,
                     const std::string& source) {
  for (const SubmapRecord& record : submaps.records) {
    bool known = store.Contains(record.keyframe);
    for (const SubmapMember& member : record.members) {
      known = known && store.Contains(member.keyframe);
    }
    if (!known) throw InputError(source + ": names keyframes that the map does not have");
  }
}

}  // namespace

SessionStart ContinueMap(const std::string& path, KeyframeStore& store, LoopCloser& closer) {
  const MapFolder map = MapFolder::Open(path);
  RequireParts(map, "continued");
  const PoseGraphData graph = map.ReadGraph();
  if (graph.vertices.empty()) throw InputError(map.path() + ": the graph has no keyframes");
  const std::string source = map.path() + "/descriptors.bin";
  const StoredSubmaps submaps = ParseSubmaps(map.ReadDescriptors(), source);
  AdoptKeyframes(map, graph, store);
  CheckReferences(submaps, store, source);
  const std::uint32_t segments = closer.Restore(graph, submaps);
  return {graph.vertices.back().id + 1, segments};
}

}  // namespace hv::loop
