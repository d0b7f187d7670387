#include "hv_sim/view_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hv_sim/mesh_builder.h"
#include "hv_sim/ray_caster.h"
#include "hv_sim/route.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kSeed = 4;

/// A room of 16 x 12 x 3 m whose floor lies at 2 m, with pillars and a low and a high table, and a
/// route around its middle; beside its wall another room that cannot be seen.
World FurnishedRoom() {
  World world;
  MeshBuilder mesh;
  mesh.AddBox(Upright({0.0, 0.0, 3.5}), Vector3d(16.0, 12.0, 3.0));
  mesh.AddBox(Upright({17.0, 0.0, 3.5}), Vector3d(16.0, 12.0, 3.0));
  for (const double x : {-5.0, 0.0, 5.0}) {
    mesh.AddBox(Upright({x, 0.0, 3.5}), Vector3d(0.5, 0.5, 3.0));
    mesh.AddBox(Upright({x, 4.5, 2.3}), Vector3d(1.5, 1.0, 0.6));
    mesh.AddBox(Upright({x, -4.5, 2.8}), Vector3d(1.5, 1.0, 0.1));
  }
  world.mesh = mesh.mesh();
  world.route = {{-6.5, -2.0, 2.0}, {6.5, -2.0, 2.0}, {6.5, 2.0, 2.0}, {-6.5, 2.0, 2.0}};
  return world;
}

TEST(ViewSamplerTest, ViewsAreClearOfEverything) {
  const World world = FurnishedRoom();
  const RayCaster caster(world.mesh);
  for (const double clearance_m : {0.2, 0.45, 0.9}) {
    ViewLimits limits;
    limits.clearance_m = clearance_m;
    const std::vector<Pose> views = SampleViews(world, 200, limits, {}, kSeed);
    ASSERT_EQ(views.size(), 200U);
    double least = 10.0;
    for (const Pose& view : views) {
      least = std::min(least, caster.Distance(view.translation(), 10.0));
    }
    EXPECT_GE(least, clearance_m);
    EXPECT_LT(least, clearance_m + 0.1);
  }
}

TEST(ViewSamplerTest, ViewsStandAtTheHeightOfASensor) {
  const World world = FurnishedRoom();
  ViewLimits limits;
  limits.least_height_m = 0.8;
  limits.most_height_m = 1.2;
  double low = 10.0;
  double high = 0.0;
  for (const Pose& view : SampleViews(world, 300, limits, {}, kSeed)) {
    const double height = view.translation().z() - 2.0;
    low = std::min(low, height);
    high = std::max(high, height);
  }
  EXPECT_GE(low, 0.8 - 1e-5);
  EXPECT_LT(low, 0.85);
  EXPECT_LE(high, 1.2 + 1e-5);
  EXPECT_GT(high, 1.15);
}

TEST(ViewSamplerTest, ViewsAreWithinSightOfTheRoute) {
  const World world = FurnishedRoom();
  const std::vector<Vector3d> route = SampleRoute(world.route, world.closed, 1.0, 0.1);
  for (const double beside_m : {0.0, 1.0, 4.0}) {
    ViewLimits limits;
    limits.beside_route_m = beside_m;
    double furthest = 0.0;
    for (const Pose& view : SampleViews(world, 200, limits, {}, kSeed)) {
      EXPECT_LT(std::abs(view.translation().x()), 8.0) << "in the room that is out of sight";
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vector3d& place : route) {
        nearest = std::min(nearest, (place - view.translation()).head<2>().norm());
      }
      furthest = std::max(furthest, nearest);
    }
    EXPECT_LE(furthest, beside_m + 1e-6);
  }
}

TEST(ViewSamplerTest, ViewsKeepAwayFromOtherPlaces) {
  const World world = FurnishedRoom();
  ViewLimits limits;
  limits.keep_away_m = 1.5;
  const std::vector<Vector3d> avoid = {{-4.0, -2.0, 3.0}, {4.0, 2.0, 3.0}, {6.5, 0.0, 3.2}};
  const auto nearest = [&](const std::vector<Vector3d>& avoided) {
    double least = 10.0;
    for (const Pose& view : SampleViews(world, 300, limits, avoided, kSeed)) {
      for (const Vector3d& place : avoid) {
        least = std::min(least, (place - view.translation()).norm());
      }
    }
    return least;
  };
  EXPECT_LT(nearest({}), 0.7);
  EXPECT_GE(nearest(avoid), 1.5);
}

TEST(ViewSamplerTest, HeadingsAreAnyAndTiltsSmall) {
  const World world = FurnishedRoom();
  ViewLimits limits;
  limits.tilt_deg = 5.0;
  std::vector<int> sectors(8, 0);
  double most_tilt = 0.0;
  for (const Pose& view : SampleViews(world, 400, limits, {}, kSeed)) {
    const Eigen::Matrix3d& rotation = view.linear();
    const double yaw = std::atan2(rotation(1, 0), rotation(0, 0));
    ++sectors[static_cast<std::size_t>(std::floor((yaw + M_PI) / (2.0 * M_PI) * 8.0)) % 8];
    most_tilt = std::max(most_tilt, std::acos(rotation(2, 2)));
  }
  EXPECT_GT(*std::min_element(sectors.begin(), sectors.end()), 25);
  EXPECT_LT(most_tilt, std::sqrt(2.0) * 5.0 * M_PI / 180.0);
  EXPECT_GT(most_tilt, 5.0 * M_PI / 180.0);
}

TEST(ViewSamplerTest, TheSeedDecides) {
  const World world = FurnishedRoom();
  const auto sample = [&](int count, std::uint32_t seed) {
    return SampleViews(world, count, {}, {}, seed);
  };
  const std::vector<Pose> views = sample(20, kSeed);
  const std::vector<Pose> again = sample(20, kSeed);
  const std::vector<Pose> fewer = sample(10, kSeed);
  const std::vector<Pose> other = sample(20, kSeed + 1);
  ASSERT_EQ(views.size(), 20U);
  ASSERT_EQ(fewer.size(), 10U);
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_EQ(views[i].matrix(), again[i].matrix());
    EXPECT_NE(views[i].matrix(), other[i].matrix());
  }
  EXPECT_EQ(views[9].matrix(), fewer[9].matrix());
}

TEST(ViewSamplerTest, WithoutRoomThereAreFewerViews) {
  const World world = FurnishedRoom();
  ViewLimits limits;
  limits.clearance_m = 5.0;
  EXPECT_TRUE(SampleViews(world, 5, limits, {}, kSeed).empty());
  limits = {};
  limits.keep_away_m = 100.0;
  EXPECT_TRUE(SampleViews(world, 5, limits, {{0.0, 0.0, 3.0}}, kSeed).empty());
}

}  // namespace
}  // namespace hv::sim
