#include "hv_replay/navigation_scenario.h"

#include <cmath>

#include <gtest/gtest.h>

#include "hv_core/error.h"

namespace hv::replay {
namespace {

using navigation::ClearanceGrid;
using navigation::Path;

/// A corridor along y in the map, from x = 0 to `width_m`.
ClearanceGrid Corridor(double width_m) {
  OccupancyGrid grid;
  grid.origin = {-1.0, 0.0};
  grid.width = 100;
  grid.height = 300;
  grid.cells.assign(100 * 300, OccupancyGrid::kFree);
  const int right = 10 + static_cast<int>(std::lround(width_m / grid.resolution_m));
  for (int row = 0; row < 300; ++row) {
    grid.At(9, row) = grid.At(right, row) = OccupancyGrid::kOccupied;
  }
  return ClearanceGrid(grid, ClearanceGrid::Unknown::kOccupied, 2.0);
}

/// A robot in the middle of the corridor that follows it; the map is turned by a right angle
/// against the world.
class Driving {
 public:
  explicit Driving(double width_m) : map_(Corridor(width_m)) {
    for (double y = 2.0; y < 25.0; y += 0.1) plan_.push_back({{0.5 * width_m, y}, 0.5 * M_PI});
    T_map_world_ = MakePose(RotationFromRpy(0.0, 0.0, 0.5 * M_PI), {0.0, 0.0, -0.2});
    const Pose T_map_base =
        MakePose(RotationFromRpy(0.0, 0.0, 0.5 * M_PI), {0.5 * width_m, 4.0, 0.0});
    T_world_base_ = T_map_world_.inverse() * T_map_base;
  }

  DriveSituation Now() const {
    return {map_, T_map_world_, T_world_base_, {0.8, 0.0}, plan_, 20.0, 7.0};
  }

 private:
  ClearanceGrid map_;
  Path plan_;
  Pose T_map_world_;
  Pose T_world_base_;
};

TEST(NavigationScenarioTest, NamesAreKnown) {
  EXPECT_EQ(ParseScenario("random"), NavigationScenario::kRandom);
  EXPECT_EQ(ParseScenario("low_obstacles"), NavigationScenario::kLowObstacles);
  EXPECT_EQ(ParseScenario("blocked_corridor"), NavigationScenario::kBlockedCorridor);
  EXPECT_THROW(ParseScenario("blocked"), InputError);
}

TEST(NavigationScenarioTest, LowBoxesLieUnderAllRays) {
  const Driving driving(3.0);
  const DriveSituation now = driving.Now();
  const auto box = BoxAhead(NavigationScenario::kLowObstacles, now);
  ASSERT_TRUE(box);
  EXPECT_EQ(box->from_s, 7.0);
  EXPECT_TRUE(std::isinf(box->until_s));
  const Eigen::Vector3d in_base = now.T_world_base.inverse() * box->center;
  EXPECT_NEAR(in_base.y(), 0.0, 0.01);
  EXPECT_NEAR(in_base.z(), 0.075, 1e-9);
  const double farthest_m = in_base.x() - 0.12 + 0.5 * box->size.head<2>().norm();
  EXPECT_GT(0.6 - farthest_m * std::tan(16.0 * M_PI / 180.0), box->size.z());
  EXPECT_GT(in_base.x() - 0.5 * box->size.head<2>().norm(), 0.9);
}

TEST(NavigationScenarioTest, LowBoxesNeedRoomToPass) {
  EXPECT_FALSE(BoxAhead(NavigationScenario::kLowObstacles, Driving(2.0).Now()));
}

TEST(NavigationScenarioTest, BarriersReachFromWallToWall) {
  const Driving driving(2.4);
  const DriveSituation now = driving.Now();
  const auto box = BoxAhead(NavigationScenario::kBlockedCorridor, now);
  ASSERT_TRUE(box);
  const Eigen::Vector3d in_base = now.T_world_base.inverse() * box->center;
  EXPECT_NEAR(in_base.x(), 3.0, 0.11);
  EXPECT_NEAR(in_base.y(), 0.0, 0.1);
  EXPECT_NEAR(box->size.y(), 2.6, 0.11);
  EXPECT_NEAR(box->size.x(), 0.3, 1e-9);
  EXPECT_EQ(box->until_s, 67.0);
  EXPECT_FALSE(LeadsPast(now.plan, now, *box, 0.25));
  EXPECT_FALSE(BoxAhead(NavigationScenario::kBlockedCorridor, Driving(6.0).Now()));
}

TEST(NavigationScenarioTest, PlansLeadPastWhatTheyDoNotTouch) {
  const Driving driving(3.0);
  const DriveSituation now = driving.Now();
  const auto box = BoxAhead(NavigationScenario::kLowObstacles, now);
  ASSERT_TRUE(box);
  EXPECT_FALSE(LeadsPast(now.plan, now, *box, 0.25));
  Path aside = now.plan;
  for (navigation::PlanarPose& pose : aside) pose.position.x() += 0.5;
  EXPECT_TRUE(LeadsPast(aside, now, *box, 0.25));
  EXPECT_FALSE(LeadsPast(aside, now, *box, 0.4));
}

TEST(NavigationScenarioTest, NothingIsPutBeforeARobotThatTurnsOrStands) {
  const Driving driving(3.0);
  for (const navigation::Velocity velocity : {navigation::Velocity{0.1, 0.0}, {0.8, 0.6}}) {
    const DriveSituation now = driving.Now();
    const DriveSituation other{now.map,  now.T_map_world, now.T_world_base, velocity,
                               now.plan, now.remaining_m, now.time_s};
    EXPECT_FALSE(BoxAhead(NavigationScenario::kLowObstacles, other));
    EXPECT_FALSE(BoxAhead(NavigationScenario::kBlockedCorridor, other));
  }
}

}  // namespace
}  // namespace hv::replay
