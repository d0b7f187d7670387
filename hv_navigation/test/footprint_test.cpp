#include "hv_navigation/footprint.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace hv::navigation {
namespace {

constexpr double kCell_m = 0.05;

OccupancyGrid Empty() {
  OccupancyGrid grid;
  grid.resolution_m = kCell_m;
  grid.origin = {-2.0, -2.0};
  grid.width = grid.height = 80;
  grid.cells.assign(80U * 80U, OccupancyGrid::kFree);
  return grid;
}

TEST(FootprintTest, Radii) {
  Footprint footprint;
  footprint.front_m = 0.5;
  footprint.back_m = 0.3;
  footprint.half_width_m = 0.2;
  footprint.margin_m = 0.05;
  EXPECT_DOUBLE_EQ(footprint.InscribedRadius(), 0.25);
  EXPECT_DOUBLE_EQ(footprint.CircumscribedRadius(), std::hypot(0.55, 0.25));
}

TEST(FootprintTest, TouchesWhatItCovers) {
  Footprint footprint;
  footprint.front_m = 0.6;
  footprint.back_m = 0.2;
  footprint.half_width_m = 0.25;
  footprint.margin_m = 0.0;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  int touching = 0;
  for (int i = 0; i < 2000; ++i) {
    const PlanarPose pose{{place(random), place(random)}, 3.0 * place(random)};
    const Eigen::Vector2d obstacle(place(random), place(random));
    OccupancyGrid cells = Empty();
    const ClearanceGrid empty(cells, ClearanceGrid::Unknown::kOccupied, 2.0);
    const Eigen::Vector2i cell = empty.CellOf(obstacle);
    cells.At(cell.x(), cell.y()) = OccupancyGrid::kOccupied;
    const ClearanceGrid grid(cells, ClearanceGrid::Unknown::kOccupied, 2.0);
    const Eigen::Vector2d there = pose.Inverse() * empty.CenterOf(cell);
    // Beyond half a diagonal of the cell the answer is certain.
    const double inside = std::min({0.6 - there.x(), 0.2 + there.x(), 0.25 - std::abs(there.y())});
    if (inside > 0.0) {
      EXPECT_TRUE(footprint.Collides(grid, pose));
      ++touching;
    }
    if (inside < -kCell_m) {
      EXPECT_FALSE(footprint.Collides(grid, pose));
    }
  }
  EXPECT_GT(touching, 100);
}

TEST(FootprintTest, KeepsItsMargin) {
  OccupancyGrid cells = Empty();
  for (int row = 0; row < cells.height; ++row) cells.At(60, row) = OccupancyGrid::kOccupied;  // x 1
  const ClearanceGrid grid(cells, ClearanceGrid::Unknown::kOccupied, 2.0);
  Footprint footprint;
  footprint.margin_m = 0.1;
  EXPECT_TRUE(footprint.Collides(grid, {{1.0 - footprint.front_m - 0.05, 0.0}, 0.0}));
  EXPECT_FALSE(footprint.Collides(grid, {{1.0 - footprint.front_m - 0.16, 0.0}, 0.0}));
}

TEST(PlanarPoseTest, IsAGroup) {
  const PlanarPose a{{1.0, -2.0}, 0.7};
  const PlanarPose b{{-0.3, 0.4}, -2.1};
  const Eigen::Vector2d point(0.2, 0.9);
  EXPECT_LT(((a * b) * point - a * (b * point)).norm(), 1e-12);
  EXPECT_LT((a.Inverse() * (a * point) - point).norm(), 1e-12);
  EXPECT_NEAR(WrappedAngle((a * a.Inverse()).yaw), 0.0, 1e-12);
}

}  // namespace
}  // namespace hv::navigation
