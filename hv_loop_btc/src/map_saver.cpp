#include "hv_loop_btc/map_saver.h"

#include <cstdio>
#include <utility>

#include "hv_core/error.h"
#include "hv_core/map_folder.h"
#include "hv_core/map_writer.h"

namespace hv::loop {
namespace {

SavedMap Describe(const std::string& path) {
  const MapFolder map = MapFolder::Open(path);
  const MapManifest& manifest = map.manifest();
  SavedMap saved{map.path(), manifest.keyframes, manifest.loops, manifest.cloud_points, 0};
  for (const MapFile& file : manifest.files) saved.bytes += file.size;
  return saved;
}

}  // namespace

MapSnapshot SnapshotOf(const LoopCloser& closer) {
  return {closer.graph().ToData(), closer.PlacedVertices(), closer.SerializedSubmaps()};
}

std::string SavedMap::ToString() const {
  char counts[160];
  std::snprintf(counts, sizeof(counts), ": %zu keyframes, %zu loops, %zu points, %.1f MB",
                keyframes, loops, points, 1e-6 * static_cast<double>(bytes));
  return path + counts;
}

MapSaver::MapSaver(const MapBuilderConfig& config, std::string configuration)
    : builder_(config), configuration_(std::move(configuration)) {}

SavedMap MapSaver::Save(const MapSnapshot& snapshot, const KeyframeStore& store,
                        const std::string& path, MapParts parts, const Progress& progress) const {
  if (snapshot.graph.vertices.empty())
    throw InputError("there is no keyframe yet, nothing to save");
  const auto report = [&progress](const char* stage, double share) {
    if (progress) progress(stage, share);
  };
  report("keyframes", 0.0);
  MapWriter writer(path);
  for (const GraphVertex& vertex : snapshot.graph.vertices) {
    writer.AddKeyframe(vertex.id, store.PathOf(vertex.id));
  }
  writer.AddGraph(snapshot.graph);
  writer.AddDescriptors(snapshot.submaps);
  if (parts == MapParts::kAll) {
    const BuiltMap built = builder_.Build(
        snapshot.placed, [&store](std::uint32_t id) { return store.Load(id); },
        writer.OccupancyPath(), [&report](double share) { report("cloud and grid", share); });
    writer.AddCloud(built.cloud);
    writer.AddGrid(built.grid);
  }
  report("writing", 0.0);
  writer.Commit(configuration_);
  return Describe(path);
}

}  // namespace hv::loop
