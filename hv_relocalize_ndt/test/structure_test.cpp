#include "hv_relocalize_ndt/structure.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "hv_core/so3.h"
#include "known_hall.h"
#include "surfaces.h"

namespace hv::relocalize {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

class VerticalOfAHall : public testing::TestWithParam<int> {};

TEST_P(VerticalOfAHall, IsFoundFrom20DegreesOff) {
  const int direction = GetParam();
  std::mt19937 random(static_cast<unsigned>(direction));
  const loop::Hall hall(31);
  const Pose pose = OnRing(direction, 4.3, 0.4, 0.12, -0.07);
  const NdtLevel scan(0.5, ScanOf(hall, pose, random));
  const Eigen::Vector3d up = pose.linear().transpose() * Eigen::Vector3d::UnitZ();
  const double around = M_PI / 4.0 * direction;
  const Eigen::Vector3d axis =
      UprightRotation(up).transpose() * Eigen::Vector3d(std::cos(around), std::sin(around), 0.0);
  const Eigen::Vector3d guess = so3::Exp(20.0 * kRadiansPerDegree * axis) * up;
  ASSERT_NEAR(AngleBetween(guess, up), 20.0 * kRadiansPerDegree, 1e-6);
  const Eigen::Vector3d estimate = EstimateUp(scan, guess);
  EXPECT_NEAR(estimate.norm(), 1.0, 1e-9);
  EXPECT_LT(AngleBetween(estimate, up), 0.3 * kRadiansPerDegree);
}

INSTANTIATE_TEST_SUITE_P(Directions, VerticalOfAHall, testing::Range(0, 8));

TEST(VerticalTest, WithoutPlanesTheGuessStays) {
  const Eigen::Vector3d guess = Eigen::Vector3d(0.2, -0.1, 2.0);
  const std::vector<NdtVoxel> clutter = {ClutterVoxel({0.0F, 1.0F, 2.0F})};
  EXPECT_LT((EstimateUp(NdtLevel(1.0, clutter), guess) - guess.normalized()).norm(), 1e-12);
  const NdtLevel nothing(1.0, std::vector<NdtVoxel>());
  EXPECT_LT((EstimateUp(nothing, guess) - guess.normalized()).norm(), 1e-12);
}

TEST(VerticalTest, UprightRotationTurnsUpToTheZAxis) {
  std::mt19937 random(32);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d up =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    const Eigen::Matrix3d rotation = UprightRotation(up);
    EXPECT_LT((rotation * up - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
    EXPECT_NEAR(so3::Log(rotation).norm(), AngleBetween(up, Eigen::Vector3d::UnitZ()), 1e-6);
  }
}

Vector3f Horizontal(double azimuth) {
  return {static_cast<float>(std::cos(azimuth)), static_cast<float>(std::sin(azimuth)), 0.0F};
}

/// The bits of a map of this one voxel.
StructureBits BitsOf(const NdtVoxel& voxel) {
  const StructureGrid grid(NdtLevel(0.5, std::vector<NdtVoxel>{voxel}), 1);
  return grid.At(0, grid.CellOf(voxel.mean.cast<double>()));
}

/// The cell of a scan that sees this voxel.
StructureCell CellOf(const NdtVoxel& voxel) {
  return StructureCells(NdtLevel(0.5, std::vector<NdtVoxel>{voxel}), Eigen::Matrix3d::Identity())
      .front();
}

TEST(StructureBitsTest, AWallFitsItselfAtAnyYaw) {
  const Vector3f place(1.1F, 0.7F, 0.4F);
  for (int yaw_deg = -360; yaw_deg <= 360; ++yaw_deg) {
    for (const double seen_at_deg : {-170.0, -31.0, 0.0, 29.9, 89.0, 151.0}) {
      const StructureCell seen =
          CellOf(PlaneVoxel(place, Horizontal(seen_at_deg * kRadiansPerDegree)));
      ASSERT_TRUE(seen.wall && !seen.level);
      const StructureBits fits = seen.Fits(static_cast<float>(yaw_deg * kRadiansPerDegree));
      // Normals have no preferred side, and may err by a quarter of a step.
      for (const double apart_deg : {0.0, 180.0, 7.0, -7.0}) {
        const double azimuth = (seen_at_deg + yaw_deg + apart_deg) * kRadiansPerDegree;
        EXPECT_NE(BitsOf(PlaneVoxel(place, Horizontal(azimuth))) & fits, 0)
            << yaw_deg << " deg, " << seen_at_deg << " deg, " << apart_deg << " deg";
      }
      for (const double apart_deg : {38.0, 60.0, 90.0, -60.0, -38.0}) {
        const double azimuth = (seen_at_deg + yaw_deg + apart_deg) * kRadiansPerDegree;
        EXPECT_EQ(BitsOf(PlaneVoxel(place, Horizontal(azimuth))) & fits, 0)
            << yaw_deg << " deg, " << seen_at_deg << " deg, " << apart_deg << " deg";
      }
    }
  }
}

TEST(StructureBitsTest, FloorsFitFloorsAndClutterFitsWhatIsUpright) {
  const NdtVoxel floor = PlaneVoxel({0.1F, 0.1F, 0.1F}, {0.1F, 0.1F, 1.0F});
  const NdtVoxel wall = PlaneVoxel({0.1F, 0.1F, 0.1F}, {0.7F, -0.7F, 0.1F});
  const NdtVoxel ramp = PlaneVoxel({0.1F, 0.1F, 0.1F}, {0.0F, 1.0F, 1.0F});
  const NdtVoxel clutter = ClutterVoxel({0.1F, 0.1F, 0.1F});
  const auto fit = [](const NdtVoxel& seen, const NdtVoxel& mapped) {
    return (CellOf(seen).Fits(0.0F) & BitsOf(mapped)) != 0;
  };
  EXPECT_TRUE(CellOf(floor).level);
  EXPECT_TRUE(fit(floor, floor));
  for (const NdtVoxel& upright : {wall, ramp, clutter}) {
    EXPECT_FALSE(fit(floor, upright));
    EXPECT_FALSE(fit(upright, floor));
    EXPECT_TRUE(fit(upright, clutter));
    EXPECT_TRUE(fit(clutter, upright));
  }
}

/// Voxels of all kinds at random in 12 x 9 x 6 cubes of half a metre.
NdtLevel RandomStructure(int count, std::mt19937& random) {
  std::uniform_real_distribution<float> share(0.0F, 1.0F);
  std::vector<NdtVoxel> voxels;
  for (int i = 0; i < count; ++i) {
    const Vector3f center(6.0F * share(random) - 2.0F, 4.5F * share(random), 3.0F * share(random));
    const Vector3f side(share(random) - 0.5F, share(random) - 0.5F, 0.0F);
    const float kind = share(random);
    if (kind < 0.4F) {
      voxels.push_back(PlaneVoxel(center, side));
    } else {
      voxels.push_back(kind < 0.7F ? PlaneVoxel(center, Vector3f::UnitZ()) : ClutterVoxel(center));
    }
  }
  return NdtLevel(0.5, voxels);
}

TEST(StructureGridTest, EveryVoxelIsInItsCube) {
  std::mt19937 random(33);
  const NdtLevel surfaces = RandomStructure(60, random);
  const StructureGrid grid(surfaces, 3);
  EXPECT_EQ(grid.cell_m(), 0.5);
  EXPECT_EQ(grid.depth(), 3);
  for (const NdtVoxel& voxel : surfaces.voxels()) {
    const Vector3i cell = grid.CellOf(voxel.mean.cast<double>());
    EXPECT_TRUE((cell.array() >= 0).all() && (cell.array() < grid.size().array()).all());
    const Eigen::Vector3d corner = grid.origin() + 0.5 * cell.cast<double>();
    const Eigen::Vector3d inside = voxel.mean.cast<double>() - corner;
    EXPECT_TRUE(inside.minCoeff() >= 0.0 && inside.maxCoeff() < 0.5);
    EXPECT_EQ(grid.At(0, cell) & BitsOf(voxel), BitsOf(voxel));
  }
}

/// Calls `body` for every cube of the window [corner, corner + width).
template <typename Body>
void ForCubes(const Vector3i& corner, int width, const Body& body) {
  for (int z = 0; z < width; ++z) {
    for (int y = 0; y < width; ++y) {
      for (int x = 0; x < width; ++x) body(corner + Vector3i(x, y, z));
    }
  }
}

TEST(StructureGridTest, WindowsHoldWhatTheirCubesHold) {
  constexpr int kDepth = 4;
  std::mt19937 random(34);
  const StructureGrid grid(RandomStructure(25, random), kDepth);
  const Vector3i start = Vector3i::Constant(-(1 << (kDepth - 1)));
  for (int level = 0; level < kDepth; ++level) {
    ForCubes(start, 24, [&](const Vector3i& cell) {
      StructureBits bits = 0;
      bool can_stand = false;
      ForCubes(cell, 1 << level, [&](const Vector3i& part) {
        bits = static_cast<StructureBits>(bits | grid.At(0, part));
        can_stand = can_stand || grid.CanStand(0, part);
      });
      ASSERT_EQ(grid.At(level, cell), bits) << level << ": " << cell.transpose();
      ASSERT_EQ(grid.CanStand(level, cell), can_stand) << level << ": " << cell.transpose();
    });
  }
}

TEST(StructureGridTest, ASensorStandsAboveFloorsOnly) {
  std::vector<NdtVoxel> voxels;
  for (float x = 0.25F; x < 5.0F; x += 0.5F) {
    for (float y = 0.25F; y < 5.0F; y += 0.5F) {
      voxels.push_back(PlaneVoxel({x, y, 0.25F}, Vector3f::UnitZ()));
      voxels.push_back(PlaneVoxel({x + 10.0F, y, 0.25F}, {1.0F, 0.0F, 1.0F}));
    }
  }
  for (float z = 0.75F; z < 8.0F; z += 0.5F) {
    voxels.push_back(PlaneVoxel({0.25F, 0.25F, z}, Vector3f::UnitX()));
    voxels.push_back(ClutterVoxel({14.75F, 0.25F, z}));
  }
  const StructureGrid grid(NdtLevel(0.5, voxels), 4);
  const auto can_stand = [&](double x, double y, double z) {
    return grid.CanStand(0, grid.CellOf({x, y, z}));
  };
  for (const double height_m : {0.3, 1.0, 2.0, 2.7}) {
    EXPECT_TRUE(can_stand(2.3, 3.1, height_m));
    EXPECT_TRUE(can_stand(4.9, 0.1, height_m));
    EXPECT_TRUE(can_stand(5.7, 2.0, height_m)) << "beside the floor";
    EXPECT_FALSE(can_stand(6.6, 2.0, height_m)) << "far from the floor";
    EXPECT_FALSE(can_stand(12.3, 3.1, height_m)) << "above a ramp";
    EXPECT_FALSE(can_stand(14.75, 0.25, height_m)) << "in clutter";
  }
  EXPECT_FALSE(can_stand(2.3, 3.1, 3.3)) << "too high";
  EXPECT_FALSE(can_stand(2.3, 3.1, -0.2)) << "below the floor";
}

}  // namespace
}  // namespace hv::relocalize
