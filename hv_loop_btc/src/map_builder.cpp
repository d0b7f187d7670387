#include "hv_loop_btc/map_builder.h"

#include <cmath>

#include "ground_grid.h"
#include "octree_writer.h"
#include "voxel_space.h"

namespace hv::loop {
namespace {

/// A keyframe in the map frame.
struct MapScan {
  Eigen::Vector3d origin;
  std::vector<MapPoint> points;
};

MapScan LoadScan(const GraphVertex& vertex, const MapBuilder::Loader& load) {
  const PointCloud cloud = load(vertex.id);
  MapScan scan;
  scan.origin = vertex.T_map_imu * cloud.sensor_origin.cast<double>();
  scan.points.reserve(cloud.points.size());
  for (const Point& point : cloud.points) {
    const Eigen::Vector3d position(point.x, point.y, point.z);
    scan.points.push_back({vertex.T_map_imu * position, point.intensity});
  }
  return scan;
}

bool IsMoving(const Surface& surface, const MapBuilderConfig& config) {
  return surface.misses >= config.min_misses &&
         surface.misses >= config.misses_per_hit * surface.hits;
}

/// At the height of the ground, within the roughness of a floor.
bool IsGround(const Surface& surface, const VoxelSpace& space, const GroundGrid& ground) {
  const Eigen::Vector3d mean = space.MeanOf(surface);
  return std::abs(mean.z() - ground.HeightAt(mean)) < 0.6 * space.voxel_m();
}

std::size_t MarkMoving(const MapBuilderConfig& config, const GroundGrid& ground,
                       VoxelSpace& space) {
  std::size_t count = 0;
  for (Surface& surface : space.surfaces()) {
    surface.moving = IsMoving(surface, config) && !IsGround(surface, space, ground);
    count += surface.moving ? 1 : 0;
  }
  return count;
}

std::vector<Point> MakeCloud(const VoxelSpace& space) {
  std::vector<Point> cloud;
  for (const Surface& surface : space.surfaces()) {
    if (surface.moving) continue;
    const Eigen::Vector3f mean = space.MeanOf(surface).cast<float>();
    Point point;
    point.x = mean.x();
    point.y = mean.y();
    point.z = mean.z();
    point.intensity = surface.intensity_sum / surface.points;
    cloud.push_back(point);
  }
  return cloud;
}

}  // namespace

void MapBuilderConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("voxel_m", voxel_m, "edge of a voxel of cloud, grid and OctoMap [m]");
  visitor.Field("max_ray_m", max_ray_m, "how far rays clear space [m]");
  visitor.Field("remove_moving", remove_moving, "leave out what later scans saw through");
  visitor.Field("min_misses", min_misses, "scans that must have seen through a voxel to remove it");
  visitor.Field("misses_per_hit", misses_per_hit, "and how many for each scan that hit it");
  visitor.Field("obstacle_min_m", obstacle_min_m,
                "height above the ground from which the grid has obstacles [m]");
  visitor.Field("obstacle_max_m", obstacle_max_m, "height up to which it has [m]");
}

void MapBuilderConfig::Validate(ConfigProblems& problems) const {
  problems.Require(voxel_m >= 0.02 && voxel_m <= 2.0, "voxel_m", "must be between 0.02 and 2");
  problems.Require(max_ray_m >= 1.0 && max_ray_m <= 500.0, "max_ray_m",
                   "must be between 1 and 500");
  problems.Require(min_misses >= 1, "min_misses", "must be at least 1");
  problems.Require(misses_per_hit > 0.0, "misses_per_hit", "must be above 0");
  problems.Require(obstacle_min_m >= 0.0, "obstacle_min_m", "must not be negative");
  problems.Require(obstacle_max_m > obstacle_min_m, "obstacle_max_m",
                   "must be above obstacle_min_m");
}

BuiltMap MapBuilder::Build(const std::vector<GraphVertex>& vertices, const Loader& load,
                           const std::string& occupancy_path, const Progress& progress) const {
  VoxelSpace space(config_.voxel_m, config_.max_ray_m);
  std::vector<Eigen::Vector3d> origins;
  double done = 0.0;
  const auto each_scan = [&](const auto& visit) {
    std::uint32_t number = 0;
    for (const GraphVertex& vertex : vertices) {
      visit(++number, LoadScan(vertex, load));
      done += 0.5 / static_cast<double>(vertices.size());
      if (progress) progress(done);
    }
  };
  each_scan([&](std::uint32_t number, const MapScan& scan) {
    space.AddHits(number, scan.points);
    origins.push_back(scan.origin);
  });
  space.FindNormals();
  each_scan([&](std::uint32_t number, const MapScan& scan) {
    space.CastRays(number, scan.origin, scan.points);
  });
  const GroundGrid ground(space, origins);
  BuiltMap map;
  if (config_.remove_moving) map.moving_voxels = MarkMoving(config_, ground, space);
  map.cloud = MakeCloud(space);
  map.grid = ground.MakeGrid(config_);
  if (!occupancy_path.empty()) WriteOcTree(space, occupancy_path);
  return map;
}

}  // namespace hv::loop
