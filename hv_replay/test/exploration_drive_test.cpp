#include "hv_replay/exploration_drive.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "box_room.h"
#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "simulated_robot.h"
#include "small_policy.h"

namespace hv::replay {
namespace {

/// A hall whose far side the robot does not see from where it starts: it sees 2.5 m.
class ExplorationDriveTest : public testing::Test {
 protected:
  ExplorationDriveTest() {
    options_.out = testing::TempDir() + "/hv_exploration_drive_test";
    options_.truth_pose = true;
    simulation_.start = {-2.5, -1.0, 0.0, 0.0};
    simulation_.point_share = 0.04;
    auto& lidar = config_.navigation.mapping.obstacle_map.lidar;
    lidar.mark_range_m = lidar.clear_range_m = 2.5;
    config_.exploration.explorer.goals.settle_s = 1.0;
  }
  void TearDown() override {
    std::filesystem::remove_all(options_.out);
    std::filesystem::remove(weights_);
  }

  ExplorationDriveResult Run() {
    return ExplorationDrive(config_, sim::BoxRoom(7.0F, 5.0F), simulation_, options_).Run();
  }

  SlamConfig config_ = SimulatedRobot();
  sim::LiveConfig simulation_;
  ExplorationDriveOptions options_;
  const std::string weights_ = testing::TempDir() + "/hv_exploration_drive_test.bin";
};

TEST_F(ExplorationDriveTest, ExploresTheSameWayEachTime) {
  const ExplorationDriveResult result = Run();
  EXPECT_TRUE(result.exploration.success) << result.exploration.reason;
  EXPECT_GT(result.coverage.back().share, 0.95);
  EXPECT_LT(result.coverage.front().share, 0.6);
  EXPECT_EQ(result.collisions.collisions, 0);
  EXPECT_GT(result.coverage.back().travelled_m, 1.5);
  ASSERT_NE(result.WhenKnown(0.9), nullptr);
  EXPECT_LT(result.WhenKnown(0.2)->time_s, result.WhenKnown(0.9)->time_s);
  for (const char* name : {"coverage.csv", "goals.csv", "path.tum", "summary.json", "config.yaml",
                           "exploration.png"}) {
    EXPECT_GT(std::filesystem::file_size(options_.out + "/" + name), 100U) << name;
  }
  const std::string coverage = ReadFile(options_.out + "/coverage.csv");
  const std::string path = ReadFile(options_.out + "/path.tum");
  EXPECT_EQ(Run().line, result.line);
  EXPECT_EQ(ReadFile(options_.out + "/coverage.csv"), coverage);
  EXPECT_EQ(ReadFile(options_.out + "/path.tum"), path);
}

TEST_F(ExplorationDriveTest, EndsInTimeAndReturns) {
  options_.time_limit_s = 5.0;
  options_.return_home = true;
  const ExplorationDriveResult result = Run();
  EXPECT_EQ(result.exploration.end, explore::ExplorationEnd::kOutOfTime);
  EXPECT_EQ(result.exploration.reason, "out of time");
  EXPECT_LT((result.line.back() - result.line.front()).norm(), 0.3);
  EXPECT_EQ(result.WhenKnown(1.01), nullptr);
}

TEST_F(ExplorationDriveTest, ExploresAsALearnedPolicySays) {
  explore::RandomNetwork()->ToCheckpoint().Write(weights_);
  config_.exploration.explorer.choice.planner = explore::kLearnedPlanner;
  config_.exploration.explorer.choice.weights = weights_;
  const ExplorationDriveResult result = Run();
  EXPECT_TRUE(result.exploration.success) << result.exploration.reason;
  EXPECT_GT(result.coverage.back().share, 0.95);
}

TEST_F(ExplorationDriveTest, DoesNotBeginWithWeightsThatCannotBeRead) {
  config_.exploration.explorer.choice.planner = explore::kLearnedPlanner;
  config_.exploration.explorer.choice.weights = weights_;
  try {
    Run();
    FAIL() << "there is no " << weights_;
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find(weights_), 0U) << error.what();
  }
}

}  // namespace
}  // namespace hv::replay
