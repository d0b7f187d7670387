#pragma once

#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "hv_core/keyframe_store.h"
#include "hv_core/map_writer.h"

namespace hv {

/// A folder of its own for each test, removed afterwards.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = testing::TempDir() + "/hv_map_XXXXXX";
    path_ = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// What an InputError of `body` says; empty when there is none.
template <typename Body>
std::string ErrorOf(const Body& body) {
  try {
    body();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline std::vector<Point> RandomPoints(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-20.0F, 20.0F);
  std::vector<Point> points(count);
  for (Point& point : points) {
    point.x = coordinate(random);
    point.y = coordinate(random);
    point.z = coordinate(random);
    point.intensity = static_cast<float>(random() % 256);
  }
  return points;
}

inline Pose RandomPose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = normal(random);
  return se3::Exp(xi);
}

inline Matrix6d RandomInformation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Matrix6d root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = normal(random);
  return root * root.transpose() + Matrix6d::Identity();
}

/// A chain of `count` poses with a true and a rejected loop.
inline PoseGraphData SmallGraph(std::uint32_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  PoseGraphData graph;
  for (std::uint32_t id = 0; id < count; ++id) {
    graph.vertices.push_back(
        {id, Time::FromNanoseconds(1646310000000000001 + id * 1000000007LL), RandomPose(random)});
    if (id == 0) continue;
    graph.edges.push_back(
        {EdgeKind::kOdometry, id - 1, id, RandomPose(random), RandomInformation(random), true});
  }
  graph.edges.push_back(
      {EdgeKind::kLoop, count - 1, 0, RandomPose(random), RandomInformation(random), true});
  graph.edges.push_back(
      {EdgeKind::kLoop, 0, count - 1, RandomPose(random), RandomInformation(random), false});
  return graph;
}

inline OccupancyGrid SmallGrid() {
  OccupancyGrid grid;
  grid.resolution_m = 0.05;
  grid.origin = {-1.25, 3.0 / 7.0};
  grid.width = 7;
  grid.height = 5;
  for (int i = 0; i < grid.width * grid.height; ++i) {
    grid.cells.push_back(i % 3 == 0
                             ? OccupancyGrid::kUnknown
                             : (i % 3 == 1 ? OccupancyGrid::kFree : OccupancyGrid::kOccupied));
  }
  return grid;
}

/// Saves a map of every kind of file; `variant` tells one map from another.
inline void SaveSmallMap(const std::string& path, const std::string& scratch, std::uint32_t variant,
                         MapWriterOptions options = {}) {
  KeyframeStore store(scratch, KeyframeStoreConfig(), Eigen::Vector3d(0.1, 0.2, 0.3));
  for (std::uint32_t id = 0; id < 3; ++id) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.points = RandomPoints(20 + variant, variant * 10 + id);
    store.Append(keyframe);
  }
  MapWriter writer(path, options);
  for (const std::uint32_t id : store.Ids()) writer.AddKeyframe(id, store.PathOf(id));
  writer.AddGraph(SmallGraph(3, variant));
  writer.AddDescriptors("descriptors " + std::to_string(variant));
  writer.AddCloud(RandomPoints(50 + variant, variant));
  writer.AddGrid(SmallGrid());
  writer.Commit("variant: " + std::to_string(variant) + "\n");
}

}  // namespace hv
