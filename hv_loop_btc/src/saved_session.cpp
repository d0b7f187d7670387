#include "hv_loop_btc/saved_session.h"

#include <limits>
#include <set>
#include <utility>

#include <yaml-cpp/yaml.h>

#include "hv_core/config.h"
#include "hv_core/error.h"
#include "required_parts.h"

namespace hv::loop {
namespace {

void CheckKeyframes(const SavedSession& session) {
  if (session.graph.vertices.empty()) {
    throw InputError(session.name + "/graph.g2o: has no keyframes");
  }
  for (const GraphVertex& vertex : session.graph.vertices) {
    if (session.clouds.count(vertex.id) != 0) continue;
    throw InputError(session.name + ": the map has no " + KeyframeFileName(vertex.id));
  }
}

void CheckSubmaps(const SavedSession& session) {
  const std::string source = session.name + "/descriptors.bin";
  if (session.submaps.records.empty()) throw InputError(source + ": has no submaps");
  for (std::size_t i = 0; i < session.submaps.records.size(); ++i) {
    const SubmapRecord& record = session.submaps.records[i];
    if (i > 0 && record.keyframe <= session.submaps.records[i - 1].keyframe) {
      throw InputError(source + ": submaps are not in order");
    }
    bool known = session.clouds.count(record.keyframe) != 0;
    for (const SubmapMember& member : record.members) {
      known = known && session.clouds.count(member.keyframe) != 0;
    }
    if (!known) throw InputError(source + ": names keyframes that the map does not have");
  }
}

/// Sessions may have run at the same time; a trajectory has one pose a stamp, so that stamps which
/// are in the map already give way by nanoseconds.
void KeepStampsApart(const PoseGraphData& before, PoseGraphData& graph) {
  std::set<std::int64_t> taken;
  for (const GraphVertex& vertex : before.vertices) taken.insert(vertex.stamp.nanoseconds());
  for (GraphVertex& vertex : graph.vertices) {
    std::int64_t stamp = vertex.stamp.nanoseconds();
    while (!taken.insert(stamp).second) ++stamp;
    vertex.stamp = Time::FromNanoseconds(stamp);
  }
}

}  // namespace

SavedSession LoadSession(const MapFolder& map) {
  RequireParts(map, "joined");
  SavedSession session;
  session.name = map.path();
  session.graph = map.ReadGraph();
  for (const std::uint32_t id : map.KeyframeIds()) {
    session.clouds[id] = map.path() + "/" + KeyframeFileName(id);
  }
  session.submaps = ParseSubmaps(map.ReadDescriptors(), map.path() + "/descriptors.bin");
  CheckKeyframes(session);
  CheckSubmaps(session);
  return session;
}

std::optional<BtcConfig> DescriptorConfigOf(const MapManifest& manifest) {
  BtcConfig config;
  try {
    const YAML::Node all = ParseYaml(manifest.configuration, "manifest.yaml");
    if (!all.IsMap() || !all["loop"]) return std::nullopt;
    const YAML::Node loop = all["loop"];
    if (!loop.IsMap() || !loop["btc"]) return std::nullopt;
    ReadConfig(loop["btc"], "manifest.yaml", config);
  } catch (const InputError&) {
    return std::nullopt;
  }
  return config;
}

SavedSession NumberedAfter(const SavedSession& before, SavedSession session) {
  const std::uint32_t offset = before.graph.vertices.back().id + 1;
  if (session.graph.vertices.back().id > std::numeric_limits<std::uint32_t>::max() - offset) {
    throw InputError(session.name + ": too many keyframes to be joined");
  }
  KeepStampsApart(before.graph, session.graph);
  for (GraphVertex& vertex : session.graph.vertices) vertex.id += offset;
  for (GraphEdge& edge : session.graph.edges) {
    edge.from += offset;
    edge.to += offset;
  }
  for (SubmapRecord& record : session.submaps.records) {
    record.keyframe += offset;
    record.travelled_m += before.submaps.records.back().travelled_m;
    for (SubmapMember& member : record.members) member.keyframe += offset;
  }
  for (BtcDescriptor& descriptor : session.submaps.descriptors) descriptor.keyframe += offset;
  std::map<std::uint32_t, std::string> clouds;
  for (auto& [id, path] : session.clouds) clouds[id + offset] = std::move(path);
  session.clouds = std::move(clouds);
  return session;
}

}  // namespace hv::loop
