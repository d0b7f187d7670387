#include "hv_lio/voxel_map.h"

#include <random>

#include <gtest/gtest.h>

#include "random_state.h"

namespace hv::lio {
namespace {

SurfaceCell CellAt(const Eigen::Vector3d& mean, double count = 10.0) {
  SurfaceCell cell;
  cell.mean = mean;
  cell.scatter = Eigen::Vector3d(1e-3, 1e-3, 1e-3).asDiagonal();
  cell.noise = 1e-4 * Eigen::Matrix3d::Identity();
  cell.count = count;
  return cell;
}

/// Flat cells scattered over z = `height` on [0, size) x [0, size).
std::vector<SurfaceCell> FloorCells(double size, double height, std::mt19937& random) {
  std::uniform_real_distribution<double> place(0.0, size);
  std::normal_distribution<double> noise(0.0, 0.005);
  std::vector<SurfaceCell> cells;
  for (int i = 0; i < static_cast<int>(60.0 * size * size); ++i) {
    const double x = place(random);
    const double y = place(random);
    cells.push_back(CellAt({x, y, height + noise(random)}, 5.0));
    cells.back().scatter = Eigen::Vector3d(2e-3, 2e-3, 2.5e-5).asDiagonal();
  }
  return cells;
}

VoxelMapConfig SmallConfig() {
  VoxelMapConfig config;
  config.capacity = 1000;
  config.max_subdivisions = 500;
  config.fit.settle_scans = 5;
  return config;
}

TEST(VoxelMapTest, KeysAreFloorOfCoordinates) {
  const VoxelMap map(SmallConfig());
  EXPECT_EQ(map.KeyOf({0.5, -0.5, 2.0}), (VoxelKey{0, -1, 2}));
}

TEST(VoxelMapTest, NeverHoldsMoreThanItsCapacityAndEvictsTheOldest) {
  VoxelMapConfig config = SmallConfig();
  config.capacity = 100;
  VoxelMap map(config);
  for (int i = 0; i < 150; ++i) map.Insert({CellAt({i + 0.5, 0.5, 0.5})}, Pose::Identity());
  EXPECT_EQ(map.size(), 100U);
  EXPECT_EQ(map.evictions(), 50U);
  EXPECT_FALSE(map.Contains({49, 0, 0}));
  EXPECT_TRUE(map.Contains({50, 0, 0}));
  map.Insert({CellAt({50.5, 0.5, 0.5})}, Pose::Identity());
  map.Insert({CellAt({500.5, 0.5, 0.5})}, Pose::Identity());
  EXPECT_TRUE(map.Contains({50, 0, 0}));
  EXPECT_FALSE(map.Contains({51, 0, 0}));
}

TEST(VoxelMapTest, SurvivesOneScanLargerThanTheTable) {
  VoxelMapConfig config = SmallConfig();
  config.capacity = 100;
  VoxelMap map(config);
  std::vector<SurfaceCell> cells;
  for (int i = 0; i < 1000; ++i) cells.push_back(CellAt({i + 0.5, 0.5, 0.5}));
  map.Insert(cells, Pose::Identity());
  EXPECT_EQ(map.size(), 100U);
  EXPECT_TRUE(map.Contains({999, 0, 0}));
  EXPECT_FALSE(map.Contains({0, 0, 0}));
}

TEST(VoxelMapTest, FlatFloorBecomesPlanes) {
  std::mt19937 random(1);
  VoxelMap map(SmallConfig());
  map.Insert(FloorCells(3.0, 0.3, random), Pose::Identity());
  const SurfaceFeature* feature = map.Find({1.5, 1.5, 0.3});
  ASSERT_NE(feature, nullptr);
  EXPECT_EQ(feature->kind, SurfaceFeature::Kind::kPlane);
  EXPECT_GT(std::abs(feature->normal().z()), 0.9995);
  EXPECT_NEAR(feature->center.z(), 0.3, 2e-3);
}

TEST(VoxelMapTest, SettledCoplanarNeighboursMergeIntoOnePlane) {
  std::mt19937 random(2);
  VoxelMap map(SmallConfig());
  for (int scan = 0; scan < 8; ++scan) map.Insert(FloorCells(3.0, 0.3, random), Pose::Identity());
  EXPECT_EQ(map.merged_planes(), 1U);
  const SurfaceFeature* a = map.Find({0.5, 0.5, 0.3});
  EXPECT_EQ(a, map.Find({2.5, 2.5, 0.3}));
  EXPECT_GT(a->variance[0], 0.5);
  std::size_t merged = 0;
  for (const VoxelView& view : map.View(1000)) {
    merged += view.kind == VoxelView::Kind::kMergedPlane ? 1U : 0U;
  }
  EXPECT_EQ(merged, 9U);
}

TEST(VoxelMapTest, StepsDoNotMerge) {
  std::mt19937 random(3);
  VoxelMap map(SmallConfig());
  for (int scan = 0; scan < 8; ++scan) {
    std::vector<SurfaceCell> cells = FloorCells(2.0, 0.3, random);
    for (SurfaceCell& cell : cells) {
      if (cell.mean.x() > 1.0) cell.mean.z() += 0.08;
    }
    map.Insert(cells, Pose::Identity());
  }
  EXPECT_EQ(map.merged_planes(), 2U);
  EXPECT_NE(map.Find({0.5, 0.5, 0.3}), map.Find({1.5, 0.5, 0.38}));
}

TEST(VoxelMapTest, ContradictedPlaneLeavesTheMergedPlaneAndFollowsTheEvidence) {
  std::mt19937 random(4);
  VoxelMap map(SmallConfig());
  for (int scan = 0; scan < 8; ++scan) map.Insert(FloorCells(3.0, 0.3, random), Pose::Identity());
  ASSERT_EQ(map.Find({0.5, 0.5, 0.3}), map.Find({2.5, 2.5, 0.3}));
  for (int scan = 0; scan < 30; ++scan) {
    std::vector<SurfaceCell> moved;
    for (SurfaceCell& cell : FloorCells(1.0, 0.5, random)) moved.push_back(cell);
    map.Insert(moved, Pose::Identity());
  }
  EXPECT_NE(map.Find({0.5, 0.5, 0.5}), map.Find({2.5, 2.5, 0.3}));
  EXPECT_NEAR(map.Find({2.5, 2.5, 0.3})->center.z(), 0.3, 2e-3);
}

TEST(VoxelMapTest, CornerIsSubdividedIntoItsFaces) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  VoxelMap map(SmallConfig());
  std::vector<SurfaceCell> cells;
  for (int i = 0; i < 600; ++i) {
    SurfaceCell cell = CellAt({place(random), place(random), 0.1});
    if (i % 2 == 0) cell.mean = Eigen::Vector3d(0.1, place(random), place(random));
    cell.scatter.setZero();
    cells.push_back(cell);
  }
  map.Insert(cells, Pose::Identity());
  EXPECT_GT(map.subdivisions(), 0U);
  const SurfaceFeature* floor = map.Find({0.75, 0.5, 0.1});
  const SurfaceFeature* wall = map.Find({0.1, 0.5, 0.75});
  ASSERT_NE(floor, nullptr);
  ASSERT_NE(wall, nullptr);
  EXPECT_GT(std::abs(floor->normal().z()), 0.99);
  EXPECT_GT(std::abs(wall->normal().x()), 0.99);
}

TEST(VoxelMapTest, SubdivisionsAreBoundedAndReturned) {
  VoxelMapConfig config = SmallConfig();
  config.capacity = 100;
  config.max_subdivisions = 20;
  VoxelMap map(config);
  std::mt19937 random(6);
  for (int i = 0; i < 400; ++i) {
    std::vector<SurfaceCell> blob;
    for (int k = 0; k < 30; ++k) {
      blob.push_back(CellAt(Eigen::Vector3d(i + 0.5, 0.5, 0.5) +
                            0.4 * RandomVector(random, 1.0).normalized()));
    }
    map.Insert(blob, Pose::Identity());
    ASSERT_LE(map.subdivisions(), 20U);
  }
  map.Clear();
  EXPECT_EQ(map.subdivisions(), 0U);
  EXPECT_EQ(map.size(), 0U);
}

TEST(PointSumsTest, CombineWithOppositeSignsRestores) {
  std::mt19937 random(7);
  PointSums sums;
  PointSums other;
  for (int i = 0; i < 20; ++i) {
    sums.Add(3.0, RandomVector(random, 1.0), 0.01 * Eigen::Matrix3d::Identity());
    other.Add(2.0, RandomVector(random, 1.0), 0.02 * Eigen::Matrix3d::Identity());
  }
  const PointSums before = sums;
  const Eigen::Vector3d offset(1.0, -2.0, 0.5);
  sums.Combine(other, offset, 1.0);
  EXPECT_NEAR(sums.count, 100.0, 1e-12);
  sums.Combine(other, offset, -1.0);
  EXPECT_LT((sums.Covariance() - before.Covariance()).norm(), 1e-10);
  EXPECT_LT((sums.Mean() - before.Mean()).norm(), 1e-12);
}

}  // namespace
}  // namespace hv::lio
