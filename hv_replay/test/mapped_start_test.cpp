#include "hv_replay/mapped_start.h"

#include <gtest/gtest.h>

#include "hv_core/error.h"

namespace hv::replay {
namespace {

/// A run through the middle of the office, in a map that lies elsewhere.
class MappedStartTest : public testing::Test {
 protected:
  MappedStartTest() {
    simulation_.people = false;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d at(15.0 + 0.5 * i, 7.6, 0.4);
      mapped_.Append(Time::FromSeconds(i), T_map_world_ * MakePose(RotationFromRpy(0, 0, 0), at));
    }
  }

  const sim::World world_ = sim::MakeWorld("office", 2);
  sim::LiveConfig simulation_;
  const Pose T_map_world_ = MakePose(RotationFromRpy(0.0, 0.0, 0.7), {5.0, -3.0, 0.0});
  Trajectory mapped_;
};

TEST_F(MappedStartTest, LiesWhereTheMapWasMade) {
  for (simulation_.seed = 1; simulation_.seed <= 5; ++simulation_.seed) {
    const auto start = WithMappedStart(simulation_, world_, mapped_, T_map_world_).start;
    ASSERT_EQ(start.size(), 4U);
    EXPECT_GE(start[0], 15.0 - 2.5);
    EXPECT_LE(start[0], 24.5 + 2.5);
    EXPECT_NEAR(start[1], 7.6, 2.5);
    EXPECT_EQ(start, WithMappedStart(simulation_, world_, mapped_, T_map_world_).start);
  }
}

TEST_F(MappedStartTest, StartsThatAreGivenStay) {
  simulation_.start = {1.0, 2.0, 0.0, 90.0};
  const auto start = WithMappedStart(simulation_, world_, mapped_, T_map_world_).start;
  EXPECT_EQ(start, simulation_.start);
}

TEST_F(MappedStartTest, SaysThatTheMapIsOfAnotherPlace) {
  const Pose elsewhere = MakePose(RotationFromRpy(0.0, 0.0, 0.0), {1000.0, 0.0, 0.0});
  EXPECT_THROW(WithMappedStart(simulation_, world_, mapped_, elsewhere), InputError);
}

}  // namespace
}  // namespace hv::replay
