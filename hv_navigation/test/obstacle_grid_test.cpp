#include "hv_navigation/obstacle_grid.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "hv_navigation/ground_model.h"
#include "solid_scene.h"

namespace hv::navigation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::int8_t kFree = OccupancyGrid::kFree;
constexpr std::int8_t kOccupied = OccupancyGrid::kOccupied;
constexpr std::int8_t kUnknown = OccupancyGrid::kUnknown;

/// A robot whose LiDAR is 0.6 m and whose camera is 0.5 m above the floor.
class ObstacleGridTest : public testing::Test {
 protected:
  Pose At(double x, double z) const {
    return MakePose(Eigen::Matrix3d(Eigen::Matrix3d::Identity()), Vector3d(x, 0.02, z));
  }
  void Look(double x, double z = 0.0) {
    const Pose T_odom_lidar = At(x, z + 0.6);
    map_.MoveTo(T_odom_lidar.translation());
    map_.Insert(Sensor::kLidar, scene_.LidarScan(T_odom_lidar, 0.5, 0.008, ++seed_), T_odom_lidar);
    if (!camera_) return;
    const Pose T_odom_camera = CameraPose(x + 0.2, z + 0.5, 20.0);
    map_.Insert(Sensor::kDepthCamera, scene_.DepthPoints(T_odom_camera, 0.5), T_odom_camera);
  }
  void Approach(double from_x, double to_x) {
    for (double x = from_x; x <= to_x; x += 0.1) Look(x);
  }
  OccupancyGrid Grid(double x, double z = 0.0) const {
    return MakeObstacleGrid(map_, GroundConfig{}, ObstacleGridConfig{}, At(x, z), 12.0);
  }
  static std::int8_t ValueAt(const OccupancyGrid& grid, double x, double y) {
    const Eigen::Vector2i cell =
        ((Vector2d(x, y) - grid.origin) / grid.resolution_m).array().floor().cast<int>();
    return grid.At(cell.x(), cell.y());
  }
  /// Cells with a value in a row along x.
  static int Count(const OccupancyGrid& grid, double from_x, double to_x, double y,
                   std::int8_t value) {
    int count = 0;
    for (double x = from_x; x < to_x - 1e-6; x += 0.1) count += ValueAt(grid, x, y) == value;
    return count;
  }

  SolidScene scene_;
  ObstacleMap map_{ObstacleMapConfig{}};
  bool camera_ = true;
  unsigned seed_ = 0;
};

TEST_F(ObstacleGridTest, LevelFloorIsFreeAndWallsAreNot) {
  scene_.AddFloor(-20.0, 20.0);
  scene_.AddBox({4.0, -5.0, 0.0}, {4.3, 5.0, 2.5});
  Approach(-0.5, 0.5);
  const OccupancyGrid grid = Grid(0.5);
  EXPECT_GE(grid.width, 120);
  for (const double y : {-2.0, -0.5, 0.0, 1.0, 2.5}) {
    EXPECT_EQ(Count(grid, -3.0, 3.8, y, kOccupied), 0) << y;
    EXPECT_GE(Count(grid, -3.0, 3.8, y, kFree), 65) << y;
    EXPECT_GE(Count(grid, 3.85, 4.25, y, kOccupied), 1) << y;
    EXPECT_EQ(Count(grid, 4.5, 6.0, y, kFree), 0) << y;
  }
}

TEST_F(ObstacleGridTest, GroundIsNotFollowedUpWalls) {
  scene_.AddFloor(-20.0, 20.0);
  scene_.AddBox({3.0, -5.0, 0.0}, {3.3, 5.0, 2.5});
  Approach(-0.5, 1.0);
  const SurfaceColumns columns(map_, At(1.0, 0.0).translation(), 12.0);
  const GroundModel ground(columns, GroundConfig{}, At(1.0, 0.0));
  for (double y = -1.95; y < 2.0; y += 0.1) {
    const auto index = [&](double x) {
      const Vector2d cell = (Vector2d(x, y) - columns.origin()) / columns.voxel_m();
      return columns.Index(cell.array().floor().cast<int>());
    };
    EXPECT_EQ(ground.KindAt(index(2.75)), Ground::kSeen) << y;
    EXPECT_NEAR(ground.HeightAt(index(2.75)), 0.0, 0.01) << y;
    EXPECT_TRUE(ground.KindAt(index(2.95)) == Ground::kStep ||
                ground.KindAt(index(3.05)) == Ground::kStep)
        << y;
  }
}

TEST_F(ObstacleGridTest, NothingSeenIsUnknownButWhereTheRobotStands) {
  const OccupancyGrid grid = Grid(0.0);
  EXPECT_EQ(ValueAt(grid, 0.05, 0.05), kFree);
  EXPECT_EQ(Count(grid, 0.6, 5.5, 0.05, kUnknown), 49);
}

TEST_F(ObstacleGridTest, LowStepIsFree) {
  scene_.AddFloor(-20.0, 2.0);
  scene_.AddFloor(2.0, 20.0, 0.03);
  Approach(-0.5, 0.5);
  const OccupancyGrid grid = Grid(0.5);
  EXPECT_EQ(Count(grid, 0.6, 4.0, 0.0, kOccupied), 0);
  EXPECT_GE(Count(grid, 0.6, 4.0, 0.0, kFree), 32);
}

TEST_F(ObstacleGridTest, HighStepIsAnObstacle) {
  for (const double edge : {2.0, 2.05}) {
    scene_ = {};
    map_ = ObstacleMap(ObstacleMapConfig{});
    scene_.AddFloor(-20.0, edge);
    scene_.AddFloor(edge, 20.0, 0.08);
    Approach(-0.5, 0.5);
    const OccupancyGrid grid = Grid(0.5);
    for (const double y : {-0.8, -0.3, 0.0, 0.4, 0.9}) {
      EXPECT_EQ(Count(grid, 0.6, 1.8, y, kOccupied), 0) << y;
      EXPECT_GE(Count(grid, 1.9, 2.3, y, kOccupied), 1) << y;
    }
  }
}

TEST_F(ObstacleGridTest, GentleRampIsFree) {
  scene_.AddFloor(-20.0, 20.0);
  scene_.AddRamp(2.0, 9.0, std::tan(10.0 * M_PI / 180.0));
  for (const bool camera : {true, false}) {
    camera_ = camera;
    map_ = ObstacleMap(ObstacleMapConfig{});
    Approach(-0.5, 0.8);
    const OccupancyGrid grid = Grid(0.8);
    for (const double y : {-1.0, 0.0, 1.0}) {
      EXPECT_EQ(Count(grid, 0.9, 5.5, y, kOccupied), 0) << y << " camera " << camera;
      EXPECT_GE(Count(grid, 0.9, 5.5, y, kFree), 38) << y << " camera " << camera;
    }
  }
}

TEST_F(ObstacleGridTest, SteepRampIsAnObstacle) {
  scene_.AddFloor(-20.0, 20.0);
  scene_.AddRamp(2.0, 5.0, std::tan(25.0 * M_PI / 180.0));
  Approach(-0.5, 0.8);
  const OccupancyGrid grid = Grid(0.8);
  for (const double y : {-1.0, 0.0, 1.0}) {
    EXPECT_EQ(Count(grid, 0.9, 1.5, y, kOccupied), 0) << y;
    EXPECT_GE(Count(grid, 2.0, 3.0, y, kOccupied), 8) << y;
  }
}

TEST_F(ObstacleGridTest, RobotOnARampSeesTheRamp) {
  const double slope = std::tan(10.0 * M_PI / 180.0);
  scene_.AddRamp(-5.0, 9.0, slope);
  const Eigen::Matrix3d tilt = RotationFromRpy(0.0, -10.0 * M_PI / 180.0, 0.0);
  const auto base = [&](double x) { return MakePose(tilt, Vector3d(x, 0.0, slope * (x + 5.0))); };
  for (double x = -0.5; x < 0.5; x += 0.1) {
    const Pose T_odom_lidar = base(x) * At(0.0, 0.6);
    map_.MoveTo(T_odom_lidar.translation());
    map_.Insert(Sensor::kLidar, scene_.LidarScan(T_odom_lidar, 0.5, 0.008, ++seed_), T_odom_lidar);
  }
  const OccupancyGrid grid =
      MakeObstacleGrid(map_, GroundConfig{}, ObstacleGridConfig{}, base(0.5), 12.0);
  for (const double y : {-1.0, 0.0, 1.0}) {
    EXPECT_EQ(Count(grid, -3.0, 4.5, y, kOccupied), 0) << y;
    EXPECT_GE(Count(grid, -3.0, 4.5, y, kFree), 65) << y;
  }
}

TEST_F(ObstacleGridTest, FloorUnderTheRobotIsNoSlopeBesideALowShelf) {
  // Seen without the floor before it, as by a robot that has forgotten what it saw: across the gap
  // it passes for a steep ramp.
  std::vector<Point> shelf;
  for (double x = -1.05; x < -0.72; x += 0.05) {
    for (double y = -0.5; y < 0.5; y += 0.05) {
      shelf.push_back({static_cast<float>(x), static_cast<float>(y), -0.42F, 1.0F, 0.0F, 0});
    }
  }
  map_.MoveTo(At(0.0, 0.6).translation());
  for (int i = 0; i < 3; ++i) map_.Insert(Sensor::kLidar, shelf, At(0.0, 0.6));
  const OccupancyGrid grid = Grid(0.0);
  EXPECT_GE(Count(grid, -1.05, -0.65, 0.05, kOccupied), 1);
  for (const double y : {-0.15, -0.05, 0.05, 0.15}) {
    EXPECT_EQ(Count(grid, -0.35, 0.4, y, kOccupied), 0) << y;
  }
}

TEST_F(ObstacleGridTest, HoleIsAnObstacle) {
  scene_.AddFloor(-20.0, 2.0);
  scene_.AddFloor(2.0, 20.0, -0.6);
  Approach(-0.5, 0.8);
  const OccupancyGrid grid = Grid(0.8);
  for (const double y : {-1.0, 0.0, 1.0}) {
    EXPECT_EQ(Count(grid, 0.9, 1.8, y, kOccupied), 0) << y;
    EXPECT_GE(Count(grid, 1.95, 2.5, y, kOccupied), 1) << y;
    // As far as rays pass, the first metre behind the edge could be a ramp.
    EXPECT_EQ(Count(grid, 3.0, 6.0, y, kFree), 0) << y;
  }
}

TEST_F(ObstacleGridTest, LowBoxIsSeenByTheCameraOnly) {
  scene_.AddFloor(-20.0, 20.0);
  scene_.AddBox({0.9, -0.15, 0.0}, {1.2, 0.15, 0.15});
  camera_ = false;
  Look(0.0);
  EXPECT_EQ(ValueAt(Grid(0.0), 0.95, 0.05), kFree);
  camera_ = true;
  for (int i = 0; i < 3; ++i) Look(0.0);
  camera_ = false;
  for (int i = 0; i < 50; ++i) Look(0.0);
  const OccupancyGrid grid = Grid(0.0);
  EXPECT_EQ(ValueAt(grid, 0.95, 0.05), kOccupied);
  EXPECT_EQ(ValueAt(grid, 0.95, -0.05), kOccupied);
  EXPECT_EQ(ValueAt(grid, 0.55, 0.05), kFree);
  EXPECT_EQ(ValueAt(grid, 0.95, 0.55), kFree);
}

TEST_F(ObstacleGridTest, OnlyWhatIsHighAboveCanBePassedUnder) {
  scene_.AddFloor(-20.0, 20.0);
  scene_.AddBox({2.0, -2.0, 0.7}, {2.3, -0.5, 0.78});
  scene_.AddBox({2.0, 0.5, 1.05}, {2.3, 2.0, 1.2});
  Approach(-0.5, 0.5);
  const OccupancyGrid grid = Grid(0.5);
  EXPECT_GE(Count(grid, 1.9, 2.4, -1.0, kOccupied), 2);
  EXPECT_EQ(Count(grid, 0.6, 4.0, 1.0, kOccupied), 0);
}

TEST_F(ObstacleGridTest, BadPoseGivesAnEmptyGrid) {
  const OccupancyGrid grid =
      MakeObstacleGrid(map_, {}, {}, At(std::numeric_limits<double>::quiet_NaN(), 0.0), 12.0);
  EXPECT_EQ(grid.width, 0);
  EXPECT_TRUE(grid.cells.empty());
}

}  // namespace
}  // namespace hv::navigation
