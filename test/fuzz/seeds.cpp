#include <cmath>
#include <filesystem>
#include <random>

#include "hv_core/file_io.h"
#include "hv_core/occupancy_grid.h"
#include "hv_core/point_cloud_file.h"
#include "hv_core/pose_graph_file.h"
#include "hv_core/trajectory.h"
#include "hv_loop_btc/submap_file.h"
#include "hv_relocalize_ndt/ndt_cache.h"
#include "readers.h"
#include "small_policy.h"

namespace hv::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSumBytes = 64;

/// What a writer of files has written.
template <typename Write>
std::string Written(const std::string& name, Write write) {
  const fs::path path = fs::temp_directory_path() / name;
  write(path.string());
  std::string bytes = ReadFile(path.string());
  fs::remove(path);
  return bytes;
}

/// A floor with a wall.
std::vector<Point> Cloud() {
  std::vector<Point> points;
  for (int i = 0; i < 60; ++i) {
    Point point;
    point.x = 0.1F * static_cast<float>(i % 10);
    point.y = 0.1F * static_cast<float>(i / 10);
    point.z = i % 10 == 9 ? point.y : 0.0F;
    points.push_back(point);
  }
  return points;
}

std::string Levels() {
  std::vector<Eigen::Vector3f> cloud;
  for (const Point& point : Cloud()) cloud.emplace_back(point.x, point.y, point.z);
  std::vector<relocalize::NdtLevel> levels;
  levels.emplace_back(0.5, cloud);
  const std::string bytes = relocalize::SerializeLevels(levels, kNdtKey);
  return bytes.substr(0, bytes.size() - kSumBytes);
}

std::string Graph(const std::string& path) {
  PoseGraphData graph;
  for (std::uint32_t id = 0; id < 3; ++id) {
    graph.vertices.push_back({id, Time::FromSeconds(10.0 + id), Pose::Identity()});
  }
  graph.edges.push_back({EdgeKind::kOdometry, 0, 1, Pose::Identity()});
  graph.edges.push_back({EdgeKind::kLoop, 0, 2, Pose::Identity()});
  WriteG2o(path, graph);
  return path;
}

std::string Grid() {
  OccupancyGrid grid;
  grid.width = 4;
  grid.height = 3;
  grid.cells.assign(12, OccupancyGrid::kFree);
  grid.cells[5] = OccupancyGrid::kOccupied;
  const fs::path folder = fs::temp_directory_path();
  WriteGrid(folder.string(), "hv_fuzz_grid", grid);
  const std::string yaml = ReadFile((folder / "hv_fuzz_grid.yaml").string());
  const std::string pgm = ReadFile((folder / "hv_fuzz_grid.pgm").string());
  fs::remove(folder / "hv_fuzz_grid.yaml");
  fs::remove(folder / "hv_fuzz_grid.pgm");
  return yaml + kGridParts + pgm;
}

std::string Policy() {
  const std::string bytes = explore::RandomNetwork()->ToCheckpoint().Serialize();
  return bytes.substr(0, bytes.size() - kSumBytes);
}

std::string Descriptors() {
  loop::StoredSubmaps submaps;
  submaps.scale = "indoor";
  submaps.records.push_back({1, Time::FromSeconds(3.0), {{1, Pose::Identity()}}, 2.0});
  submaps.descriptors.emplace_back();
  return loop::Serialize(submaps);
}

}  // namespace

std::map<std::string, std::string> Seeds() {
  std::map<std::string, std::string> seeds;
  seeds["point_cloud"] =
      Written("hv_fuzz.pcd", [](const std::string& path) { WritePcd(path, Cloud()); });
  seeds["trajectory"] = Written("hv_fuzz.tum", [](const std::string& path) {
    WriteTum(path, Trajectory({{Time::FromSeconds(1.0)}, {Time::FromSeconds(2.5)}}));
  });
  seeds["graph"] = Written("hv_fuzz.g2o", Graph);
  seeds["grid"] = Grid();
  seeds["floor_plan"] = "image: plan.pgm\nresolution: 0.1\norigin: [0.0, 0.0, 0.0]\n";
  seeds["policy"] = Policy();
  seeds["descriptors"] = Descriptors();
  seeds["ndt_levels"] = Levels();
  seeds["config"] = "odometry:\n  threads: 2\n  map: {voxel_size_m: 0.5}\n";
  seeds["fault"] = "lidar_gap:start=40,duration=10";
  seeds["tiles"] = "map small 1 1\n" + std::string(2, '#') + "..S............#\n";
  seeds["curve_panels"] = "panel,curve,x,y\nloss,train,1,2.5\n";
  seeds["kitti_calibration"] = "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n";
  seeds["kitti_poses"] = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  seeds["kitti_times"] = "0.0\n0.1\n";
  seeds["nclt_imu"] = "1326030975726043,0.1,0.2,0.3,0.0,0.1,-9.8,0.01,0.0,0.0\n";
  seeds["nclt_truth"] = "1326030975726043,1.0,2.0,3.0,0.1,0.2,0.3\n";
  return seeds;
}

}  // namespace hv::fuzz
