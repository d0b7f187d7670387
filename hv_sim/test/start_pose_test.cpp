#include "hv_sim/start_pose.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "box_room.h"
#include "hv_core/error.h"
#include "hv_sim/ground.h"

namespace hv::sim {
namespace {

class StartPoseTest : public testing::TestWithParam<const char*> {};

TEST_P(StartPoseTest, TheRobotStandsFreeOnTheFloor) {
  const World world = MakeWorld(GetParam(), 2);
  const auto scene = std::make_shared<RayCaster>(world.mesh);
  const RobotBodyConfig robot;
  const CollisionChecker checker(robot.shape, scene, world.people);
  std::vector<Eigen::Vector3d> places;
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    const Pose T_world_base = RandomStart(world, scene, robot, seed);
    EXPECT_EQ(T_world_base.matrix(), RandomStart(world, scene, robot, seed).matrix());
    const Clearance clearance = checker.At(T_world_base, 0.0, 2.0);
    EXPECT_GE(clearance.static_m, 0.15);
    EXPECT_GE(clearance.person_m, 1.0);
    const auto floor =
        FloorBelow(*scene, T_world_base.translation() + Eigen::Vector3d(0.0, 0.0, 0.3), 1.0);
    ASSERT_TRUE(floor.has_value());
    EXPECT_NEAR(*floor, T_world_base.translation().z(), 0.03);
    EXPECT_GT(T_world_base.linear()(2, 2), 0.95);
    for (const Eigen::Vector3d& other : places) {
      EXPECT_GT((other - T_world_base.translation()).norm(), 1e-3);
    }
    places.push_back(T_world_base.translation());
    RobotBody body(robot, scene, world.people, seed);
    EXPECT_NO_THROW(body.Place(T_world_base));
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, StartPoseTest,
                         testing::Values("office", "warehouse", "construction"),
                         [](const auto& test) { return std::string(test.param); });

TEST(StartPoseErrorTest, AWorldWithoutRoomIsRefused) {
  World world = BoxRoom(0.7F, 0.6F);
  world.route = {{-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.1, 0.0}};
  const auto scene = std::make_shared<RayCaster>(world.mesh);
  EXPECT_THROW(RandomStart(world, scene, {}, 1), InputError);
}

}  // namespace
}  // namespace hv::sim
