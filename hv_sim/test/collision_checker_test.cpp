#include "hv_sim/collision_checker.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "hv_sim/mesh_builder.h"
#include "hv_sim/random.h"

namespace hv::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFar = 3.0;

std::shared_ptr<const RayCaster> SceneOf(const MeshBuilder& builder) {
  return std::make_shared<RayCaster>(builder.mesh());
}

MeshBuilder Floor() {
  MeshBuilder builder;
  builder.AddQuad({-20.0, -20.0, 0.0}, {40.0, 0.0, 0.0}, {0.0, 40.0, 0.0});
  return builder;
}

double StaticGap(const MeshBuilder& builder, const Pose& T_world_base) {
  return CollisionChecker({}, SceneOf(builder), {}).At(T_world_base, 0.0, kFar).static_m;
}

TEST(CollisionCheckerTest, TheFloorIsNoObstacle) {
  EXPECT_EQ(StaticGap(Floor(), Upright({1.0, 2.0, 0.0}, 0.3)), kFar);
}

TEST(CollisionCheckerTest, GapToAWallIsThatOfTheNearestCorner) {
  MeshBuilder builder = Floor();
  builder.AddQuad({2.0, -10.0, 0.0}, {0.0, 20.0, 0.0}, {0.0, 0.0, 3.0}, 5.0);
  for (const double yaw : {0.0, 0.4, 1.2, 2.0, 3.1, -2.5}) {
    const Pose T_world_base = Upright({0.5, 0.3, 0.0}, yaw);
    double furthest = -10.0;
    for (const double x : {-0.30, 0.30}) {
      for (const double y : {-0.25, 0.25}) {
        furthest = std::max(furthest, (T_world_base * Vector3d(x, y, 0.0)).x());
      }
    }
    EXPECT_NEAR(StaticGap(builder, T_world_base), 2.0 - furthest, 1e-6) << yaw;
  }
  EXPECT_EQ(StaticGap(builder, Upright({1.8, 0.0, 0.0})), 0.0);
}

TEST(CollisionCheckerTest, OnlyTheHeightOfTheRobotCounts) {
  const auto gap = [](double low, double high) {
    MeshBuilder builder = Floor();
    builder.AddBox(Pose::Identity(), Vector3d(1.0, -0.5, low), Vector3d(2.0, 0.5, high));
    return StaticGap(builder, Pose::Identity());
  };
  EXPECT_NEAR(gap(0.0, 0.15), 0.7, 1e-6);
  EXPECT_NEAR(gap(0.0, 0.045), 0.7, 1e-6);
  EXPECT_NEAR(gap(0.65, 0.9), 0.7, 1e-6);
  EXPECT_EQ(gap(0.0, 0.035), kFar);
  EXPECT_EQ(gap(0.75, 0.9), kFar);
}

TEST(CollisionCheckerTest, SlopedThingsAreCutAtTheHeightOfTheRobot) {
  // A board that rises from the floor at x = 1 m with 45 degrees reaches 0.04 m at 1.04 m.
  MeshBuilder builder = Floor();
  builder.AddQuad({1.0, -2.0, 0.0}, {2.0, 0.0, 2.0}, {0.0, 4.0, 0.0}, 10.0);
  EXPECT_NEAR(StaticGap(builder, Pose::Identity()), 0.74, 1e-6);
  // From behind, its underside comes down to 0.7 m at 1.7 m.
  EXPECT_NEAR(StaticGap(builder, Upright({3.0, 0.0, 0.0})), 1.0, 1e-6);
}

TEST(CollisionCheckerTest, ARampUnderTheWheelsIsNoObstacle) {
  constexpr double kSlope = 0.15;
  MeshBuilder builder;
  builder.AddQuad({-5.0, -5.0, -5.0 * std::tan(kSlope)}, {10.0, 0.0, 10.0 * std::tan(kSlope)},
                  {0.0, 10.0, 0.0});
  EXPECT_EQ(StaticGap(builder, MakePose(RotationFromRpy(0.0, -kSlope, 0.0), Vector3d::Zero())),
            kFar);
  EXPECT_EQ(StaticGap(builder, Pose::Identity()), 0.0);
}

/// Gap by brute force: points on the triangles against points in the footprint.
double SampledGap(const RayCaster::Triangle& triangle, const Pose& T_base_world) {
  const RobotShape shape;
  double least = kFar;
  constexpr int kSteps = 400;
  for (int i = 0; i <= kSteps; ++i) {
    for (int k = 0; k <= kSteps - i; ++k) {
      const float a = static_cast<float>(i) / kSteps;
      const float b = static_cast<float>(k) / kSteps;
      const Eigen::Vector3f point =
          triangle[0] + a * (triangle[1] - triangle[0]) + b * (triangle[2] - triangle[0]);
      const Vector3d at = T_base_world * Vector3d(point.cast<double>());
      if (at.z() < shape.bottom_m || at.z() > shape.top_m) continue;
      const Vector2d inside(std::clamp(at.x(), -shape.back_m, shape.front_m),
                            std::clamp(at.y(), -shape.half_width_m, shape.half_width_m));
      least = std::min(least, (at.head<2>() - inside).norm());
    }
  }
  return least;
}

TEST(CollisionCheckerTest, RandomTrianglesAgreeWithSampling) {
  Random random({11U});
  const auto corner = [&random] {
    return Vector3d(random.Uniform(-1.2, 1.2), random.Uniform(-1.2, 1.2),
                    random.Uniform(-0.5, 1.2));
  };
  int apart = 0;
  for (int k = 0; k < 60; ++k) {
    MeshBuilder builder;
    builder.AddTriangle(corner(), corner(), corner());
    const auto& vertices = builder.mesh().vertices;
    const Pose T_world_base =
        MakePose(RotationFromRpy(random.Uniform(-0.2, 0.2), random.Uniform(-0.2, 0.2),
                                 random.Uniform(-3.0, 3.0)),
                 Vector3d(random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0), 0.0));
    const double gap = StaticGap(builder, T_world_base);
    const double sampled =
        SampledGap({vertices[0], vertices[1], vertices[2]}, T_world_base.inverse());
    EXPECT_NEAR(gap, sampled, 0.012) << k;
    EXPECT_LE(gap, sampled + 1e-6) << k;
    if (gap > 0.05 && gap < kFar) ++apart;
  }
  EXPECT_GT(apart, 15);
}

TEST(CollisionCheckerTest, PeopleCountWhereTheyAreAtThatTime) {
  // One walks along x = 2 m past the robot.
  PersonPath path;
  path.waypoints = {{2.0, -10.0, 0.0}, {2.0, 10.0, 0.0}};
  path.speed = 1.0;
  const CollisionChecker checker({}, SceneOf(Floor()), {path});
  const auto gap = [&](double time_s) {
    return checker.At(Pose::Identity(), time_s, kFar).person_m;
  };
  EXPECT_EQ(gap(0.0), kFar);
  // Beside her, the nearest part is a leg or a hand, 0.1 to 0.31 m off her middle.
  EXPECT_GT(gap(10.0), 1.7 - 0.35);
  EXPECT_LT(gap(10.0), 1.7 - 0.1);
  EXPECT_EQ(checker.At(Upright({1.9, 0.0, 0.0}), 10.0, kFar).person_m, 0.0);
  EXPECT_GT(checker.At(Upright({1.9, 0.0, 0.0}), 8.0, kFar).person_m, 1.0);
  EXPECT_EQ(checker.At(Upright({1.9, 0.0, 0.0}), 10.0, kFar).static_m, kFar);
}

TEST(CollisionCheckerTest, ConfigurationIsChecked) {
  RobotShape shape;
  shape.front_m = 0.0;
  shape.top_m = 0.01;
  ConfigProblems problems;
  shape.Validate(problems);
  EXPECT_EQ(problems.lines().size(), 2U);
}

}  // namespace
}  // namespace hv::sim
