#include "hv_navigation/obstacle_map.h"

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <tuple>

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include "small_map.h"
#include "solid_scene.h"

namespace hv::navigation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;
using State = ObstacleMap::State;

Pose At(double x, double y, double z) {
  return MakePose(Eigen::Matrix3d(Eigen::Matrix3d::Identity()), Vector3d(x, y, z));
}

ObstacleMapConfig SmallConfig() {
  ObstacleMapConfig config;
  config.region_m = 4.0;
  config.region_height_m = 2.0;
  return config;
}

/// All leaves of the map.
std::vector<VoxelView> LeavesOf(const ObstacleMap& map) {
  std::vector<VoxelView> leaves;
  constexpr int kFar = 1 << 15;
  map.Visit(Vector3i::Constant(-kFar), Vector3i::Constant(kFar),
            [&](const VoxelView& voxel) { leaves.push_back(voxel); });
  return leaves;
}

/// Share of the way at which the segment enters and leaves a voxel; empty when it does not.
std::pair<double, double> Crossing(const Vector3d& from, const Vector3d& to, const Vector3d& low,
                                   double side) {
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = to[axis] - from[axis];
    const double a = (low[axis] - from[axis]) / way;
    const double b = (low[axis] + side - from[axis]) / way;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return {enter, leave};
}

TEST(ObstacleMapTest, OneScanMatchesBruteForce) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> coordinate(-1.9F, 1.9F);
  const Pose T_odom_lidar = MakePose(RotationFromRpy(0.3, -0.2, 1.0), Vector3d(0.13, -0.22, 0.07));
  std::vector<Point> points(60);
  std::map<std::tuple<int, int, int>, int> hits;
  ObstacleMap map(SmallConfig());
  for (Point& point : points) {
    point.x = coordinate(random);
    point.y = coordinate(random);
    point.z = 0.5F * coordinate(random);
    const Vector3d end = T_odom_lidar * Eigen::Vector3f(point.x, point.y, point.z).cast<double>();
    const Vector3i cell = map.VoxelOf(end);
    // One ray a voxel, so that it is known which is drawn.
    ASSERT_EQ(++hits[std::make_tuple(cell.x(), cell.y(), cell.z())], 1);
  }
  const InsertReport report = map.Insert(Sensor::kLidar, points, T_odom_lidar);
  EXPECT_EQ(report.marked + report.too_near, points.size());
  int checked = 0;
  for (int x = -25; x < 25; ++x) {
    for (int y = -25; y < 25; ++y) {
      for (int z = -15; z < 15; ++z) {
        const Vector3d low = 0.1 * Vector3d(x, y, z);
        bool hit = false;
        bool passed = false;
        bool touched = false;
        for (const Point& point : points) {
          const Vector3d in_sensor = Eigen::Vector3f(point.x, point.y, point.z).cast<double>();
          if (in_sensor.norm() < SmallConfig().lidar.min_range_m) continue;
          const Vector3d end = T_odom_lidar * in_sensor;
          if (map.VoxelOf(end) == Vector3i(x, y, z)) {
            hit = true;
            continue;
          }
          const auto [enter, leave] = Crossing(T_odom_lidar.translation(), end, low, 0.1);
          passed = passed || leave > enter + 1e-9;
          touched = touched || leave > enter - 1e-9;
        }
        const State state = map.StateAt(low + Vector3d::Constant(0.05));
        if (hit) {
          EXPECT_EQ(state, State::kOccupied);
        } else if (passed) {
          EXPECT_EQ(state, State::kFree);
        } else if (!touched) {
          EXPECT_EQ(state, State::kUnknown);
        }
        checked += hit || passed ? 1 : 0;
      }
    }
  }
  EXPECT_GT(checked, 500);
}

TEST(ObstacleMapTest, PersonWhoLeavesIsCleared) {
  SolidScene scene;
  scene.AddFloor(-20.0, 20.0);
  scene.AddBox({6.0, -20.0, 0.0}, {6.5, 20.0, 3.0});
  ObstacleMap map{ObstacleMapConfig{}};
  unsigned seed = 1;
  const auto scan = [&](double x) {
    const Pose T_odom_lidar = At(x, 0.0, 0.6);
    map.Insert(Sensor::kLidar, scene.LidarScan(T_odom_lidar, 0.6, 0.01, ++seed), T_odom_lidar);
  };
  scene.AddBox({3.0, -0.25, 0.0}, {3.4, 0.25, 1.7});
  for (int i = 0; i < 20; ++i) scan(0.0);
  const auto occupied = [&] {
    int count = 0;
    for (const VoxelView& leaf : LeavesOf(map)) {
      const Vector3d at = 0.1 * leaf.low.cast<double>();
      count +=
          leaf.occupied && at.x() > 2.7 && at.x() < 3.6 && std::abs(at.y()) < 0.5 && at.z() > 0.05;
    }
    return count;
  };
  EXPECT_GT(occupied(), 50);
  scene.RemoveLast();
  for (int i = 0; i < 6; ++i) scan(0.0);
  EXPECT_EQ(occupied(), 0);
}

TEST(ObstacleMapTest, PersonWhoWalksLeavesNoGhosts) {
  SolidScene scene;
  scene.AddFloor(-20.0, 20.0);
  scene.AddBox({7.0, -20.0, 0.0}, {7.5, 20.0, 3.0});
  ObstacleMap map{ObstacleMapConfig{}};
  unsigned seed = 1;
  double x = 0.0;
  const auto scan = [&] {
    x += 0.05;
    const Pose T_odom_lidar = At(x, 0.0, 0.6);
    map.Insert(Sensor::kLidar, scene.LidarScan(T_odom_lidar, 0.6, 0.01, ++seed), T_odom_lidar);
  };
  // Below what the highest ring reaches from the end of the way, 2.5 m away.
  const auto occupied = [&] {
    int count = 0;
    for (const VoxelView& leaf : LeavesOf(map)) {
      const Vector3d at = 0.1 * leaf.low.cast<double>();
      count += leaf.occupied && at.x() > 3.5 && at.x() < 6.0 && std::abs(at.y()) < 2.5 &&
               at.z() > 0.05 && at.z() < 1.15;
    }
    return count;
  };
  for (int i = 0; i < 30; ++i) {
    const double y = -2.0 + 0.12 * i;
    scene.AddBox({5.0, y, 0.0}, {5.3, y + 0.4, 1.7});
    scan();
    scene.RemoveLast();
  }
  EXPECT_GT(occupied(), 20);
  EXPECT_LT(occupied(), 200) << "the way that the person walked is cleared behind";
  const int before = occupied();
  for (int i = 0; i < 8; ++i) scan();
  EXPECT_LT(occupied(), before / 10);
  // Voxels that one ray hit near their bottom wait for a ray that passes as low.
  for (int i = 0; i < 12; ++i) scan();
  EXPECT_EQ(occupied(), 0);
}

TEST(ObstacleMapTest, ReturnsWinOverRaysOfTheSameScan) {
  ObstacleMap map{ObstacleMapConfig{}};
  std::vector<Point> points(40);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    points[i].x = 4.0F;
    points[i].y = 0.004F * static_cast<float>(i);
    points[i].z = 0.1F * static_cast<float>(i % 2);
  }
  points.back().x = 2.0F;
  points.back().y = 0.03F;
  points.back().z = 0.02F;
  const Pose T_odom_lidar = At(0.01, 0.01, 0.01);
  for (int i = 0; i < 20; ++i) map.Insert(Sensor::kLidar, points, T_odom_lidar);
  EXPECT_EQ(map.StateAt({2.01, 0.04, 0.03}), State::kOccupied);
  points.pop_back();
  for (int i = 0; i < 4; ++i) map.Insert(Sensor::kLidar, points, T_odom_lidar);
  EXPECT_EQ(map.StateAt({2.01, 0.04, 0.03}), State::kFree);
}

TEST(ObstacleMapTest, FloorStaysUnderGrazingRays) {
  SolidScene scene;
  scene.AddFloor(-20.0, 20.0, 0.03);
  ObstacleMap map{ObstacleMapConfig{}};
  unsigned seed = 1;
  for (int i = 0; i < 60; ++i) {
    const Pose T_odom_lidar = At(0.05 * i, 0.0, 0.63);
    map.Insert(Sensor::kLidar, scene.LidarScan(T_odom_lidar, 0.6, 0.005, ++seed), T_odom_lidar);
  }
  int seen = 0;
  int lost = 0;
  for (int i = 0; i < 40; ++i) {
    const State state = map.StateAt({2.25 + 0.1 * i, 0.05, 0.05});
    seen += state == State::kOccupied;
    lost += state == State::kFree;
  }
  EXPECT_GT(seen, 33);
  // Rays that land just behind a voxel pass it within an eighth of its height.
  EXPECT_LE(lost, 2);
}

class LowBox : public testing::Test {
 protected:
  LowBox() {
    scene_.AddFloor(-20.0, 20.0);
    scene_.AddBox({10.0, -20.0, 0.0}, {10.5, 20.0, 3.0});
  }
  /// The lowest ring passes 2 to 5 cm over its far end, within the voxels of its top.
  void PlaceBox() { scene_.AddBox({1.25, -0.15, 0.0}, {1.5, 0.15, 0.15}); }
  void TakeLidar() {
    const std::vector<Point> points = scene_.LidarScan(At(0.0, 0.0, 0.6), 0.6, 0.01, ++seed_);
    map_.Insert(Sensor::kLidar, points, At(0.0, 0.0, 0.6));
  }
  void TakeCamera(double down_deg) {
    const Pose T_odom_camera = CameraPose(0.2, 0.5, down_deg);
    map_.Insert(Sensor::kDepthCamera, scene_.DepthPoints(T_odom_camera, 0.5), T_odom_camera);
  }
  int BoxVoxels() const {
    int count = 0;
    for (int x = 13; x < 15; ++x) {
      for (int y = -1; y < 1; ++y) {
        const Vector3d at = 0.1 * Vector3d(x + 0.5, y + 0.5, 1.2);
        count += map_.StateAt(at) == State::kOccupied;
      }
    }
    return count;
  }

  SolidScene scene_;
  ObstacleMap map_{ObstacleMapConfig{}};
  unsigned seed_ = 0;
};

TEST_F(LowBox, SeenByTheCameraStaysUnderTheLidar) {
  PlaceBox();
  for (int i = 0; i < 5; ++i) TakeLidar();
  EXPECT_EQ(BoxVoxels(), 0) << "the LiDAR cannot see it";
  for (int i = 0; i < 3; ++i) TakeCamera(20.0);
  EXPECT_EQ(BoxVoxels(), 4);
  for (int i = 0; i < 100; ++i) TakeLidar();
  EXPECT_EQ(BoxVoxels(), 4);
}

TEST_F(LowBox, AppearsWhileTheLidarPassesOverIt) {
  for (int i = 0; i < 10; ++i) TakeLidar();
  PlaceBox();
  for (int i = 0; i < 5; ++i) {
    TakeLidar();
    for (int frame = 0; frame < 2; ++frame) TakeCamera(20.0);
  }
  EXPECT_EQ(BoxVoxels(), 4);
}

TEST_F(LowBox, IsClearedWhenTheCameraSeesThrough) {
  PlaceBox();
  for (int i = 0; i < 10; ++i) TakeCamera(20.0);
  EXPECT_EQ(BoxVoxels(), 4);
  scene_.RemoveLast();
  for (int i = 0; i < 10; ++i) TakeCamera(20.0);
  EXPECT_EQ(BoxVoxels(), 0);
}

TEST_F(LowBox, ThinTopBetweenRingsIsKeptAndBodiesAreNot) {
  // Rings 18 and 19 of the LiDAR pass at 0.671 and 0.705 m over x = 2.
  scene_.AddBox({1.9, -0.3, 0.68}, {2.1, 0.3, 0.695});
  for (int i = 0; i < 3; ++i) TakeCamera(0.0);
  ASSERT_EQ(map_.StateAt({1.95, 0.02, 0.65}), State::kOccupied);
  for (int i = 0; i < 50; ++i) TakeLidar();
  EXPECT_EQ(map_.StateAt({1.95, 0.02, 0.65}), State::kOccupied);
  scene_.RemoveLast();
  scene_.AddBox({1.9, -0.3, 0.0}, {2.1, 0.3, 1.0});
  for (int i = 0; i < 10; ++i) TakeCamera(0.0);
  ASSERT_EQ(map_.StateAt({1.95, 0.02, 0.45}), State::kOccupied);
  scene_.RemoveLast();
  for (int i = 0; i < 8; ++i) TakeLidar();
  EXPECT_EQ(map_.StateAt({1.95, 0.02, 0.45}), State::kFree);
}

TEST(ObstacleMapTest, KeepsARegionAndItsMemory) {
  SolidScene scene;
  scene.AddFloor(-20.0, 200.0);
  for (int i = 0; i < 60; ++i) scene.AddBox({3.0 * i, 2.0, 0.0}, {3.0 * i + 0.5, 2.5, 1.5});
  ObstacleMap map(SmallConfig());
  std::size_t half_way = 0;
  for (int i = 0; i < 300; ++i) {
    const Pose T_odom_lidar = At(0.5 * i, 0.0, 0.6);
    map.MoveTo(T_odom_lidar.translation());
    map.Insert(Sensor::kLidar, scene.LidarScan(T_odom_lidar, 2.0, 0.0, 1), T_odom_lidar);
    if (i == 60) half_way = map.node_count();
  }
  EXPECT_LT(map.node_count(), half_way * 12 / 10);
  std::size_t leaves = 0;
  for (const VoxelView& leaf : LeavesOf(map)) {
    ++leaves;
    const Vector3d low = 0.1 * leaf.low.cast<double>() - Vector3d(149.5, 0.0, 0.6);
    EXPECT_GE(low.minCoeff(), -5.6);
    EXPECT_LE((low + Vector3d::Constant(0.1 * leaf.side)).maxCoeff(), 5.6);
  }
  EXPECT_GT(leaves, 1000U);
  EXPECT_EQ(map.StateAt({0.0, 0.0, 0.6}), State::kUnknown);
  EXPECT_NE(map.StateAt({149.5, 0.0, 0.65}), State::kUnknown);
  map.MoveTo({-150.0, 0.0, 0.0});
  EXPECT_EQ(map.node_count(), 0U);
}

TEST(ObstacleMapTest, LimitsOfMarkingAndClearing) {
  ObstacleMapConfig config;
  config.lidar.mark_range_m = 5.0;
  config.lidar.clear_range_m = 3.0;
  ObstacleMap map(config);
  Point near;
  near.x = 4.0F;
  Point far;
  far.y = 6.0F;
  const InsertReport report = map.Insert(Sensor::kLidar, {near, far}, At(0.05, 0.05, 0.05));
  EXPECT_EQ(report.marked, 1U);
  EXPECT_EQ(report.only_clear, 1U);
  EXPECT_EQ(map.StateAt({4.05, 0.05, 0.05}), State::kOccupied);
  EXPECT_EQ(map.StateAt({2.85, 0.05, 0.05}), State::kFree);
  EXPECT_EQ(map.StateAt({3.25, 0.05, 0.05}), State::kUnknown);
  EXPECT_EQ(map.StateAt({0.05, 2.85, 0.05}), State::kFree);
  EXPECT_EQ(map.StateAt({0.05, 6.05, 0.05}), State::kUnknown);
}

TEST(ObstacleMapTest, RaysTakeTurnsInClearingWhatIsFar) {
  ObstacleMapConfig config;
  config.lidar.far_m = 6.0;
  config.lidar.far_every = 2;
  ObstacleMap map(config);
  std::vector<Point> points(2);
  points[0].x = points[1].y = 14.0F;
  const auto cleared = [&](double range_m) {
    return static_cast<int>(map.StateAt({range_m, 0.05, 0.05}) == State::kFree) +
           static_cast<int>(map.StateAt({0.05, range_m, 0.05}) == State::kFree);
  };
  map.Insert(Sensor::kLidar, points, At(0.05, 0.05, 0.05));
  EXPECT_EQ(cleared(5.0), 2);
  EXPECT_EQ(cleared(12.0), 1);
  map.Insert(Sensor::kLidar, points, At(0.05, 0.05, 0.05));
  EXPECT_EQ(cleared(12.0), 2);
}

TEST(ObstacleMapTest, BadInputIsCounted) {
  ObstacleMap map(SmallConfig());
  EXPECT_EQ(map.Insert(Sensor::kLidar, {}, At(0.0, 0.0, 0.0)).points, 0U);
  EXPECT_EQ(map.node_count(), 0U);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<Point> points(5);
  points[0].x = kNan;
  points[1].y = -kInfinity;
  points[2].z = 3e38F;
  points[4].x = 3e3F;
  const InsertReport report = map.Insert(Sensor::kLidar, points, At(0.0, 0.0, 0.0));
  EXPECT_EQ(report.invalid, 3U);
  EXPECT_EQ(report.too_near, 1U);
  EXPECT_EQ(report.only_clear, 1U);
  const std::size_t nodes = map.node_count();
  EXPECT_TRUE(map.Insert(Sensor::kLidar, points, At(kNan, 0.0, 0.0)).refused);
  EXPECT_TRUE(map.Insert(Sensor::kLidar, points, At(9.0, 0.0, 0.0)).refused);
  map.MoveTo({kNan, 0.0, 0.0});
  map.MoveTo({1e9, 0.0, 0.0});
  map.MoveTo({3275.0, 0.0, 0.0});
  EXPECT_EQ(map.node_count(), nodes);
  EXPECT_EQ(map.StateAt({1e9, kNan, 0.0}), State::kUnknown);
}

TEST(ObstacleMapTest, BinaryFileHoldsTheSame) {
  SolidScene scene;
  scene.AddFloor(-20.0, 20.0);
  scene.AddBox({2.0, -1.0, 0.0}, {2.5, 1.0, 1.0});
  ObstacleMap map(SmallConfig());
  map.Insert(Sensor::kLidar, scene.LidarScan(At(0, 0, 0.6), 1.0, 0.0, 1), At(0, 0, 0.6));
  const TemporaryFolder folder;
  map.WriteBinary(folder / "map.bt");
  octomap::OcTree tree(1.0);
  ASSERT_TRUE(tree.readBinary(folder / "map.bt"));
  EXPECT_NEAR(tree.getResolution(), 0.1, 1e-9);
  std::size_t occupied = 0;
  for (const VoxelView& leaf : LeavesOf(map)) {
    const Vector3d at = 0.1 * (leaf.low.cast<double>() + Vector3d::Constant(0.5 * leaf.side));
    const octomap::OcTreeNode* node = tree.search(at.x(), at.y(), at.z());
    ASSERT_NE(node, nullptr);
    EXPECT_EQ(tree.isNodeOccupied(node), leaf.occupied);
    occupied += leaf.occupied;
  }
  EXPECT_GT(occupied, 100U);
  EXPECT_NE(ErrorOf([&] { map.WriteBinary(folder / "none" + "/map.bt"); }), "");
}

TEST(ObstacleMapTest, IsDeterministic) {
  SolidScene scene;
  scene.AddFloor(-20.0, 20.0);
  const auto run = [&] {
    ObstacleMap map{ObstacleMapConfig{}};
    for (unsigned i = 0; i < 5; ++i) {
      const Pose pose = At(0.1 * i, 0.0, 0.6);
      map.Insert(Sensor::kLidar, scene.LidarScan(pose, 1.0, 0.02, i), pose);
    }
    return LeavesOf(map);
  };
  const std::vector<VoxelView> a = run();
  const std::vector<VoxelView> b = run();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].low, b[i].low);
    EXPECT_EQ(a[i].occupied, b[i].occupied);
    EXPECT_EQ(a[i].high_m, b[i].high_m);
  }
}

}  // namespace
}  // namespace hv::navigation
