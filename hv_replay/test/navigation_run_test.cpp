#include "hv_replay/navigation_run.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "box_room.h"
#include "hv_core/error.h"
#include "simulated_robot.h"

namespace hv::replay {
namespace {

/// Owns the folder of results.
class NavigationRunTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(options_.out); }

  NavigationRunTest() {
    options_.out = testing::TempDir() + "/hv_navigation_run_test";
    options_.goals = 2;
    options_.least_m = 3.0;
    simulation_.start = {-3.0, -2.0, 0.0, 90.0};
    simulation_.point_share = 0.1;
  }

  std::vector<NavigationTrial> Run() {
    return NavigationRun(config_, sim::BoxRoom(12.0F, 9.0F), simulation_, options_).Run();
  }

  SlamConfig config_ = SimulatedRobot();
  sim::LiveConfig simulation_;
  NavigationRunOptions options_;
};

TEST_F(NavigationRunTest, DrivesToGoalsTheSameWayEachTime) {
  const std::vector<NavigationTrial> trials = Run();
  ASSERT_EQ(trials.size(), 2U);
  for (const NavigationTrial& trial : trials) {
    EXPECT_TRUE(trial.reached) << trial.reason;
    EXPECT_EQ(trial.collisions, 0);
    EXPECT_LT(trial.EndDistance(), 0.2);
    EXPECT_GT(trial.driven_m, 2.5);
    EXPECT_FALSE(trial.plan_ms.empty());
    EXPECT_NEAR(0.1 * static_cast<double>(trial.control_ms.size()), trial.time_s, 1e-6);
    EXPECT_GT(trial.octree_nodes, 1000U);
  }
  EXPECT_EQ(trials[1].start.position, trials[0].end.position);
  for (const char* name : {"trials.csv", "cycles.csv", "summary.json", "drives.png"}) {
    EXPECT_GT(std::filesystem::file_size(options_.out + "/" + name), 100U) << name;
  }
  const std::vector<NavigationTrial> again = Run();
  ASSERT_EQ(again.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(again[k].goal.position, trials[k].goal.position);
    EXPECT_EQ(again[k].line, trials[k].line);
  }
}

TEST_F(NavigationRunTest, DrivesByTheTruth) {
  options_.truth_pose = true;
  options_.goals = 1;
  const std::vector<NavigationTrial> trials = Run();
  ASSERT_EQ(trials.size(), 1U);
  EXPECT_TRUE(trials[0].reached) << trials[0].reason;
  EXPECT_LT(trials[0].worst_place_m, 1e-6);
}

TEST_F(NavigationRunTest, RefusesAMapWithoutItsTruth) {
  options_.map = "somewhere";
  EXPECT_THROW(Run(), InputError);
}

}  // namespace
}  // namespace hv::replay
