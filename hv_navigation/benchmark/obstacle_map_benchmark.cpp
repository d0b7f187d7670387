#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <octomap/OcTree.h>

#include "hv_navigation/depth_projection.h"
#include "hv_navigation/obstacle_grid.h"
#include "hv_navigation/obstacle_map.h"
#include "hv_navigation/planning_config.h"
#include "hv_navigation/surroundings.h"
#include "hv_sim/lidar.h"
#include "hv_sim/world.h"

namespace hv::navigation {
namespace {

constexpr int kScans = 30;
constexpr double kStep_m = 0.1;
constexpr double kLidar_m = 0.6;

/// Scans of a robot that drives the first metres of the office's route.
class Drive {
 public:
  static const Drive& Get() {
    static const Drive drive;
    return drive;
  }

  std::vector<Pose> T_odom_base;
  std::vector<Pose> T_odom_lidar;
  std::vector<std::vector<Point>> scans;

 private:
  Drive() {
    const sim::World world = sim::MakeWorld("office", 1);
    sim::LidarOptions options;
    options.people = false;
    options.azimuth_keep = 0.5;
    const sim::LidarSimulator lidar(world, sim::PandarXt32(), options, 1);
    const Eigen::Vector3d from = world.route[0];
    const Eigen::Vector3d ahead = (world.route[1] - from).normalized();
    const Eigen::Matrix3d heading = RotationFromRpy(0.0, 0.0, std::atan2(ahead.y(), ahead.x()));
    for (int i = 0; i < kScans; ++i) {
      T_odom_base.push_back(MakePose(heading, from + kStep_m * i * ahead));
      T_odom_lidar.push_back(T_odom_base.back() * Eigen::Translation3d(0.0, 0.0, kLidar_m));
      const Pose& pose = T_odom_lidar.back();
      scans.push_back(lidar.Sweep(0.1 * i, [&](double) { return pose; }).points);
    }
  }
};

ObstacleMapConfig ConfigOf(const benchmark::State& state) {
  ObstacleMapConfig config;
  config.voxel_m = 0.01 * static_cast<double>(state.range(0));
  return config;
}

ObstacleMap FilledMap(const ObstacleMapConfig& config) {
  const Drive& drive = Drive::Get();
  ObstacleMap map(config);
  map.MoveTo(drive.T_odom_base.front().translation());
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    map.MoveTo(drive.T_odom_base[i].translation());
    map.Insert(Sensor::kLidar, drive.scans[i], drive.T_odom_lidar[i]);
  }
  return map;
}

/// One scan after the other, region and new space included.
void InsertLidar(benchmark::State& state) {
  const Drive& drive = Drive::Get();
  ObstacleMap map(ConfigOf(state));
  std::size_t i = 0;
  for (auto _ : state) {
    map.MoveTo(drive.T_odom_base[i].translation());
    benchmark::DoNotOptimize(map.Insert(Sensor::kLidar, drive.scans[i], drive.T_odom_lidar[i]));
    i = (i + 1) % drive.scans.size();
  }
  state.counters["points"] = static_cast<double>(drive.scans[0].size());
  state.counters["nodes"] = static_cast<double>(map.node_count());
}
BENCHMARK(InsertLidar)->ArgName("voxel_cm")->Arg(10)->Arg(5)->Unit(benchmark::kMillisecond);

/// The same by OctoMap itself, one ray a voxel.
void InsertByOctomap(benchmark::State& state) {
  const Drive& drive = Drive::Get();
  const ObstacleMapConfig config = ConfigOf(state);
  octomap::OcTree tree(config.voxel_m);
  std::vector<octomap::Pointcloud> clouds;
  std::vector<octomap::point3d> origins;
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    clouds.emplace_back();
    for (const Point& point : drive.scans[i]) {
      const Eigen::Vector3d in_lidar = Eigen::Vector3f(point.x, point.y, point.z).cast<double>();
      const Eigen::Vector3f at = (drive.T_odom_lidar[i] * in_lidar).cast<float>();
      clouds.back().push_back(at.x(), at.y(), at.z());
    }
    const Eigen::Vector3f at = drive.T_odom_lidar[i].translation().cast<float>();
    origins.emplace_back(at.x(), at.y(), at.z());
  }
  std::size_t i = 0;
  for (auto _ : state) {
    tree.insertPointCloud(clouds[i], origins[i], config.lidar.clear_range_m, false, true);
    i = (i + 1) % clouds.size();
  }
  state.counters["nodes"] = static_cast<double>(tree.size());
}
BENCHMARK(InsertByOctomap)->ArgName("voxel_cm")->Arg(10)->Arg(5)->Unit(benchmark::kMillisecond);

void Grid(benchmark::State& state) {
  const Drive& drive = Drive::Get();
  const ObstacleMap map = FilledMap(ConfigOf(state));
  const auto side_m = static_cast<double>(state.range(1));
  for (auto _ : state) {
    benchmark::DoNotOptimize(MakeObstacleGrid(map, GroundConfig{}, ObstacleGridConfig{},
                                              drive.T_odom_base.back(), side_m));
  }
  const OccupancyGrid grid =
      MakeObstacleGrid(map, GroundConfig{}, ObstacleGridConfig{}, drive.T_odom_base.back(), side_m);
  std::map<int, int> cells;
  for (const std::int8_t cell : grid.cells) ++cells[cell];
  state.counters["free"] = cells[OccupancyGrid::kFree];
  state.counters["occupied"] = cells[OccupancyGrid::kOccupied];
}
BENCHMARK(Grid)
    ->ArgNames({"voxel_cm", "side_m"})
    ->Args({10, 12})
    ->Args({10, 40})
    ->Args({5, 12})
    ->Unit(benchmark::kMillisecond);

/// A wall, with a pixel in fifty at random.
DepthImage Wall() {
  DepthImage image;
  image.width = 640;
  image.height = 480;
  for (int i = 0; i < image.width * image.height; ++i) {
    const int noise = i * 7919 % 5003;
    image.depth_mm.push_back(static_cast<std::uint16_t>(noise < 100 ? 500 + noise : 2000));
  }
  return image;
}

void Depth(benchmark::State& state) {
  const DepthImage image = Wall();
  const DepthCameraModel camera{385.0, 385.0, 320.0, 240.0};
  for (auto _ : state) benchmark::DoNotOptimize(ProjectDepth(image, camera, DepthConfig{}));
}
BENCHMARK(Depth)->Unit(benchmark::kMillisecond);

void InsertDepth(benchmark::State& state) {
  const DepthCameraModel camera{385.0, 385.0, 320.0, 240.0};
  const DepthCloud cloud = ProjectDepth(Wall(), camera, DepthConfig{});
  ObstacleMap map{ObstacleMapConfig{}};
  for (auto _ : state) {
    benchmark::DoNotOptimize(map.Insert(Sensor::kDepthCamera, cloud.points, Pose::Identity()));
  }
  state.counters["points"] = static_cast<double>(cloud.points.size());
}
BENCHMARK(InsertDepth)->Unit(benchmark::kMillisecond);

/// All that is done with a scan: obstacle map, local grid, and the grid of the map, grown from
/// nothing or over a saved map of 150 x 150 m.
void UpdateSurroundings(benchmark::State& state) {
  const Drive& drive = Drive::Get();
  MappingConfig config;
  config.obstacle_map = ConfigOf(state);
  std::optional<OccupancyGrid> saved;
  if (state.range(1) != 0) {
    saved = OccupancyGrid();
    saved->resolution_m = 0.05;
    saved->width = saved->height = 3000;
    saved->origin.setConstant(-75.0);
    saved->cells.assign(9'000'000, OccupancyGrid::kFree);
  }
  Surroundings surroundings(config, PlanningConfig().NeededClearance(), saved);
  std::size_t i = 0;
  for (auto _ : state) {
    surroundings.AddScan(Time(), drive.scans[i], drive.T_odom_lidar[i], drive.T_odom_base[i]);
    benchmark::DoNotOptimize(surroundings.Update(drive.T_odom_base[i], Pose::Identity()).map);
    i = (i + 1) % drive.scans.size();
  }
  state.counters["points"] = static_cast<double>(drive.scans[0].size());
}
BENCHMARK(UpdateSurroundings)
    ->ArgNames({"voxel_cm", "saved"})
    ->Args({10, 0})
    ->Args({10, 1})
    ->Args({5, 0})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hv::navigation

BENCHMARK_MAIN();
