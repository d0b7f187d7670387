#include "voxel_ray.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace hv::navigation {
namespace {

TEST(VoxelRay, PassesEachCellThatTheSegmentTouches) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-12.0, 12.0);
  const auto draw = [&] {
    return Eigen::Vector3d::NullaryExpr([&] { return coordinate(random); });
  };
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Vector3d from = draw();
    Eigen::Vector3d to = draw();
    if (trial % 3 == 0) to[trial % 2] = from[trial % 2];
    Eigen::Vector3i at = from.array().floor().cast<int>();
    double entered = 0.0;
    TraverseVoxels(from, to, [&](const Eigen::Vector3i& cell, double enter, double leave) {
      EXPECT_LE((cell - at).lpNorm<1>(), 1);
      EXPECT_EQ(enter, entered);
      EXPECT_GE(leave, enter);
      const Eigen::Vector3d middle = from + 0.5 * (enter + leave) * (to - from);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(middle[axis], cell[axis] - 1e-9);
        EXPECT_LE(middle[axis], cell[axis] + 1.0 + 1e-9);
      }
      at = cell;
      entered = leave;
    });
    const Eigen::Vector3i last = to.array().floor().cast<int>();
    EXPECT_LE((last - at).lpNorm<1>(), 1);
    EXPECT_LE(entered, 1.0 + 1e-12);
  }
}

TEST(VoxelRay, EndsForAwkwardSegments) {
  const Eigen::Vector3d corner(2.0, -3.0, 1.0);
  for (const Eigen::Vector3d& to :
       {corner, Eigen::Vector3d(5.0, 0.0, 4.0), Eigen::Vector3d(-1.0, -6.0, -2.0),
        Eigen::Vector3d(2.0, -3.0 + 1e-15, 9.0), Eigen::Vector3d(2.0, -3.0, -1e-300)}) {
    int visits = 0;
    TraverseVoxels(corner, to, [&](const Eigen::Vector3i&, double, double) { ++visits; });
    const Eigen::Vector3i way = (to.array().floor() - corner.array().floor()).cast<int>();
    EXPECT_EQ(visits, way.lpNorm<1>());
  }
}

}  // namespace
}  // namespace hv::navigation
