#include "hv_loop_btc/map_builder.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include "hv_core/error.h"
#include "simulated_room.h"

namespace hv::loop {
namespace {

constexpr int kScans = 30;

struct Counts {
  double still = 0.0;
  double moving = 0.0;
};

class MapBuilderTest : public testing::Test {
 protected:
  BuiltMap Build(bool with_walker, const MapBuilderConfig& config) const {
    std::mt19937 random(5);
    std::vector<GraphVertex> vertices = room_.Vertices(kScans);
    std::normal_distribution<double> noise(0.0, pose_sigma_);
    for (GraphVertex& vertex : vertices) {
      Vector6d xi;
      for (int i = 0; i < 6; ++i) xi[i] = pose_sigma_ > 0.0 ? noise(random) : 0.0;
      vertex.T_map_imu = vertex.T_map_imu * se3::Exp(xi);
    }
    return MapBuilder(config).Build(
        vertices,
        [&](std::uint32_t id) {
          random.seed(id);
          return room_.Scan(static_cast<int>(id), with_walker, random);
        },
        occupancy_path_);
  }

  Counts Count(const std::vector<Point>& cloud) const {
    Counts counts;
    for (const Point& point : cloud) {
      const Eigen::Vector3d position(point.x, point.y, point.z);
      (room_.DistanceToStatic(position) < 0.06 ? counts.still : counts.moving) += 1.0;
    }
    return counts;
  }

  std::int8_t CellAt(const OccupancyGrid& grid, double x, double y) const {
    const int column = static_cast<int>(std::floor((x - grid.origin.x()) / grid.resolution_m));
    const int row = static_cast<int>(std::floor((y - grid.origin.y()) / grid.resolution_m));
    if (column < 0 || row < 0 || column >= grid.width || row >= grid.height) {
      return OccupancyGrid::kUnknown;
    }
    return grid.At(column, row);
  }

  /// Something within a cell of the position.
  bool IsBlocked(const OccupancyGrid& grid, double x, double y) const {
    for (int i = 0; i < 9; ++i) {
      const double dx = 0.1 * (i % 3 - 1);
      const double dy = 0.1 * (i / 3 - 1);
      if (CellAt(grid, x + dx, y + dy) == OccupancyGrid::kOccupied) return true;
    }
    return false;
  }

  void TearDown() override {
    if (!occupancy_path_.empty()) std::remove(occupancy_path_.c_str());
  }

  SimulatedRoom room_;
  double pose_sigma_ = 0.0;  ///< of each axis [m], [rad]
  std::string occupancy_path_;
};

TEST_F(MapBuilderTest, RemovesAWalkerAndKeepsTheRoom) {
  MapBuilderConfig config;
  const Counts filtered = Count(Build(true, config).cloud);
  config.remove_moving = false;
  const Counts all = Count(Build(true, config).cloud);
  ASSERT_GT(all.moving, 1000.0);
  EXPECT_LT(filtered.moving, 0.1 * all.moving);
  EXPECT_GT(filtered.still, 0.99 * all.still);
}

TEST_F(MapBuilderTest, ARoomWithoutWalkerStaysWhole) {
  const BuiltMap map = Build(false, {});
  EXPECT_LT(static_cast<double>(map.moving_voxels), 0.005 * static_cast<double>(map.cloud.size()));
  for (const Point& point : map.cloud) EXPECT_FLOAT_EQ(point.intensity, 9.0F);
}

/// Noise of poses smears walls over neighbouring voxels, of which the outer ones may go; no part of
/// a surface may go altogether.
TEST_F(MapBuilderTest, NoisyPosesLeaveNoHoles) {
  pose_sigma_ = 0.003;
  MapBuilderConfig config;
  const BuiltMap filtered = Build(false, config);
  config.remove_moving = false;
  const BuiltMap all = Build(false, config);
  const auto cube = [](const Point& point) {
    return std::array<int, 3>{static_cast<int>(std::floor(point.x / 0.3F)),
                              static_cast<int>(std::floor(point.y / 0.3F)),
                              static_cast<int>(std::floor(point.z / 0.3F))};
  };
  std::map<std::array<int, 3>, int> points_before;
  std::map<std::array<int, 3>, int> points_after;
  for (const Point& point : all.cloud) ++points_before[cube(point)];
  for (const Point& point : filtered.cloud) ++points_after[cube(point)];
  int holes = 0;
  for (const auto& [key, count] : points_before) {
    holes += count > 5 && points_after.count(key) == 0 ? 1 : 0;
  }
  EXPECT_GT(all.cloud.size(), filtered.cloud.size());
  EXPECT_EQ(holes, 0);
}

TEST_F(MapBuilderTest, TheGridHasObstaclesFloorAndUnknown) {
  const OccupancyGrid grid = Build(true, {}).grid;
  EXPECT_DOUBLE_EQ(grid.resolution_m, 0.1);
  EXPECT_TRUE(IsBlocked(grid, 2.0, 1.2)) << "pillar";
  EXPECT_TRUE(IsBlocked(grid, -1.0, -4.2)) << "chest";
  EXPECT_TRUE(IsBlocked(grid, -5.0, 3.0)) << "table top";
  EXPECT_TRUE(IsBlocked(grid, 8.0, 0.0)) << "wall";
  EXPECT_EQ(CellAt(grid, -9.0, 0.0), OccupancyGrid::kUnknown);  // outside
  int occupied = 0;
  for (double x = -7.5; x < 4.8; x += 0.1) {
    for (double y = -4.0; y < 0.9; y += 0.1) {
      EXPECT_NE(CellAt(grid, x, y), OccupancyGrid::kUnknown) << x << " " << y;
      occupied += CellAt(grid, x, y) == OccupancyGrid::kOccupied ? 1 : 0;
    }
  }
  EXPECT_LE(occupied, 2) << "the walker left traces on the floor";
}

TEST_F(MapBuilderTest, TheOctoMapIsReadByOctoMap) {
  occupancy_path_ = testing::TempDir() + "/hv_map_builder_test.bt";
  const BuiltMap map = Build(true, {});
  octomap::OcTree tree(0.5);
  ASSERT_TRUE(tree.readBinary(occupancy_path_));
  EXPECT_DOUBLE_EQ(tree.getResolution(), 0.1);
  for (const Point& point : map.cloud) {
    const octomap::OcTreeNode* node = tree.search(point.x, point.y, point.z);
    ASSERT_NE(node, nullptr);
    ASSERT_TRUE(tree.isNodeOccupied(node));
  }
  const octomap::OcTreeNode* middle = tree.search(0.0, 0.0, 1.0);
  ASSERT_NE(middle, nullptr);
  EXPECT_FALSE(tree.isNodeOccupied(middle));
  EXPECT_EQ(tree.search(20.0, 0.0, 1.0), nullptr);
  std::size_t occupied = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const double voxels = std::round(leaf.getSize() / tree.getResolution());
    if (tree.isNodeOccupied(*leaf)) occupied += static_cast<std::size_t>(std::pow(voxels, 3.0));
  }
  EXPECT_EQ(occupied, map.cloud.size());
}

TEST_F(MapBuilderTest, NothingEmptyAndFarAwayAreHandled) {
  occupancy_path_ = testing::TempDir() + "/hv_map_builder_test.bt";
  const MapBuilder builder((MapBuilderConfig()));
  const auto nothing = [](std::uint32_t) { return PointCloud(); };
  EXPECT_TRUE(builder.Build({}, nothing, occupancy_path_).cloud.empty());
  EXPECT_TRUE(builder.Build(room_.Vertices(3), nothing, occupancy_path_).grid.cells.empty());
  const auto far = [](std::uint32_t) {
    PointCloud cloud;
    cloud.points.resize(3);
    cloud.points[0].x = 1e9F;
    cloud.points[1].y = 5000.0F;
    cloud.points[2].z = 2.0F;
    return cloud;
  };
  const BuiltMap map = builder.Build(room_.Vertices(3), far, occupancy_path_);
  EXPECT_EQ(map.cloud.size(), 6U);
  EXPECT_LT(map.grid.width, 2000);
}

TEST_F(MapBuilderTest, AFailingLoaderOrDiskIsReported) {
  const MapBuilder builder((MapBuilderConfig()));
  const auto broken = [](std::uint32_t) -> PointCloud { throw InputError("gone"); };
  EXPECT_THROW(builder.Build(room_.Vertices(1), broken), InputError);
  const auto nothing = [](std::uint32_t) { return PointCloud(); };
  EXPECT_THROW(builder.Build(room_.Vertices(1), nothing, "/nonexistent/a.bt"), InputError);
}

/// The floor is followed up a ramp; a step is an obstacle.
TEST(MapGround, RampsAreFloorAndStepsAreNot) {
  std::vector<GraphVertex> vertices;
  const auto floor_at = [](double x) { return x < 2.0 ? 0.0 : 0.2 * (x - 2.0); };
  for (int i = 0; i < 8; ++i) {
    const double x = 1.0 * i;
    vertices.push_back({static_cast<std::uint32_t>(i), Time(),
                        Pose(Eigen::Translation3d(x, 0.0, floor_at(x) + 0.7))});
  }
  const auto load = [&](std::uint32_t id) {
    PointCloud cloud;
    const Eigen::Vector3d sensor = vertices[id].T_map_imu.translation();
    for (double x = -1.0; x < 9.0; x += 0.05) {
      for (double y = -3.0; y < 3.0; y += 0.05) {
        const double step = y > 1.5 ? 0.15 : 0.0;
        const Eigen::Vector3d ground(x, y, floor_at(x) + step + 0.001 * (id % 3));
        if ((ground - sensor).norm() > 6.0 || (ground - sensor).norm() < 1.2) continue;
        const Eigen::Vector3f point = (ground - sensor).cast<float>();
        cloud.points.push_back({point.x(), point.y(), point.z(), 1.0F, 0.0F, 0});
      }
    }
    return cloud;
  };
  const OccupancyGrid grid = MapBuilder(MapBuilderConfig()).Build(vertices, load).grid;
  int occupied_floor = 0;
  int occupied_step = 0;
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const double y = grid.origin.y() + (row + 0.5) * grid.resolution_m;
      if (grid.At(column, row) != OccupancyGrid::kOccupied) continue;
      (y < 1.45 ? occupied_floor : occupied_step) += 1;
    }
  }
  EXPECT_EQ(occupied_floor, 0);
  EXPECT_GT(occupied_step, 1000);
}

TEST(MapBuilderConfigTest, TellsWhatIsWrong) {
  ConfigProblems none;
  MapBuilderConfig().Validate(none);
  EXPECT_TRUE(none.lines().empty());
  MapBuilderConfig config;
  config.voxel_m = 0.0;
  config.obstacle_max_m = 0.0;
  ConfigProblems two;
  config.Validate(two);
  EXPECT_EQ(two.lines().size(), 2U);
}

}  // namespace
}  // namespace hv::loop
