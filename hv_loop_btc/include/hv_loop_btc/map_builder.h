#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hv_core/config.h"
#include "hv_core/occupancy_grid.h"
#include "hv_core/point_cloud_file.h"
#include "hv_core/pose_graph_data.h"

namespace hv::loop {

struct MapBuilderConfig {
  double voxel_m = 0.1;
  double max_ray_m = 30.0;
  bool remove_moving = true;
  int min_misses = 3;
  double misses_per_hit = 3.0;
  double obstacle_min_m = 0.1;
  double obstacle_max_m = 1.8;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What is made of all keyframes, in the map frame.
struct BuiltMap {
  std::vector<Point> cloud;       ///< one mean point for each occupied voxel
  OccupancyGrid grid;             ///< of the floor that was driven on
  std::size_t moving_voxels = 0;  ///< left out because the sensor saw through them
};

/// Builds the saved cloud, a 2-D grid and an OctoMap from keyframe clouds and corrected poses.
///
/// Keyframes are loaded one after the other, twice: first to collect the voxels they hit, then to
/// cast their rays. Memory grows with the area of the map, not with the number of keyframes.
///
/// Moving objects: a voxel is left out when at least `min_misses` keyframes, and `misses_per_hit`
/// times as many as hit it, saw through its points to something behind. Static surfaces that rays
/// graze are protected: in flat surroundings only rays count that cross the plane at 10 degrees or
/// more and end behind it, and nothing at the height of the ground is ever removed.
///
/// Ground: followed from under the trajectory across neighbouring cells, so that ramps are floor
/// and curbs are not; of floors above each other the one of the first keyframe. Cells are occupied
/// where something stands `obstacle_min_m` to `obstacle_max_m` above the ground, free where rays
/// passed there or hit the ground.
class MapBuilder {
 public:
  /// Points of a keyframe in the frame of its pose, with PointCloud::sensor_origin. May throw.
  using Loader = std::function<PointCloud(std::uint32_t id)>;
  /// Called with the share of the work done, in [0, 1].
  using Progress = std::function<void(double)>;

  explicit MapBuilder(const MapBuilderConfig& config) : config_(config) {}

  /// `vertices`: poses in a frame with z up. With an `occupancy_path` the OctoMap is written there
  /// (.bt); it reaches 32768 voxels from the origin. Throws InputError when that fails. The result
  /// depends on the arguments alone.
  BuiltMap Build(const std::vector<GraphVertex>& vertices, const Loader& load,
                 const std::string& occupancy_path = "", const Progress& progress = {}) const;

 private:
  const MapBuilderConfig config_;
};

}  // namespace hv::loop
