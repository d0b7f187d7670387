#include "hv_replay/reachable_ground.h"

#include <gtest/gtest.h>

#include "box_room.h"
#include "hv_sim/mesh_builder.h"

namespace hv::replay {
namespace {

const Pose kStart = sim::Upright({1.0, 1.0, 0.0});

TEST(ReachableGroundTest, IsTheFloorLessABorderAsWideAsTheRobot) {
  const ReachableGround ground(sim::BoxRoom(12.0F, 9.0F), sim::RobotShape(), kStart);
  EXPECT_NEAR(ground.area_m2(), 11.5 * 8.5, 4.0);
}

TEST(ReachableGroundTest, TellsHowMuchOfItAMapKnows) {
  const ReachableGround ground(sim::BoxRoom(12.0F, 9.0F), sim::RobotShape(), kStart);
  OccupancyGrid map;
  map.resolution_m = 0.5;
  map.origin = {0.0, -5.0};  // the half with x above 0
  map.width = 20;
  map.height = 20;
  map.cells.assign(400, OccupancyGrid::kFree);
  EXPECT_NEAR(ground.ShareKnown(map, Pose::Identity()), 0.5, 0.03);
  const Pose T_map_world = sim::Upright({-12.0, 0.0, 0.0});
  EXPECT_EQ(ground.ShareKnown(map, T_map_world), 0.0);
  map.cells.assign(400, OccupancyGrid::kOccupied);
  EXPECT_EQ(ground.ShareKnown(map, Pose::Identity()), 0.0);
}

}  // namespace
}  // namespace hv::replay
