#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hv_core/keyframe_store.h"
#include "hv_core/pose_graph_data.h"
#include "hv_loop_btc/loop_closer.h"
#include "hv_loop_btc/map_builder.h"

namespace hv::loop {

/// What a map is saved from: the state of a LoopCloser at one moment, so that a map can be built
/// while the LoopCloser goes on.
struct MapSnapshot {
  PoseGraphData graph;
  std::vector<GraphVertex> placed;  ///< those whose place in the map is known: what is seen of it
  std::string submaps;              ///< LoopCloser::SerializedSubmaps()
};

MapSnapshot SnapshotOf(const LoopCloser& closer);

/// What has been saved.
struct SavedMap {
  std::string path;
  std::size_t keyframes = 0;
  std::size_t loops = 0;   ///< accepted
  std::size_t points = 0;  ///< of cloud.pcd
  std::uintmax_t bytes = 0;

  /// "/maps/office: 120 keyframes, 8 loops, 345678 points, 12.3 MB".
  std::string ToString() const;
};

enum class MapParts {
  kAll,
  /// Graph, keyframes and descriptors: what the rest can be made of, and what takes no time.
  kEssential
};

/// Saves maps, offline and online alike. Const methods are thread-safe.
class MapSaver {
 public:
  /// Called with what is being done and the share of it that is done, in [0, 1]. What it throws
  /// ends the save; the old map is then untouched.
  using Progress = std::function<void(const char* stage, double share)>;

  /// `configuration`: YAML text, saved in the manifest.
  MapSaver(const MapBuilderConfig& config, std::string configuration);

  /// Writes the map folder `path`, atomically (see MapWriter). `store` holds the clouds of all
  /// vertices. Throws InputError when the snapshot is empty or the disk fails.
  SavedMap Save(const MapSnapshot& snapshot, const KeyframeStore& store, const std::string& path,
                MapParts parts = MapParts::kAll, const Progress& progress = {}) const;

 private:
  MapBuilder builder_;
  std::string configuration_;
};

}  // namespace hv::loop
