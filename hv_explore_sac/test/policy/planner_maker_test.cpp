#include "hv_explore_sac/policy/planner_maker.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "hv_explore_sac/train/train_config.h"
#include "small_policy.h"
#include "toy_exploration.h"

namespace hv::explore {
namespace {

/// A file that is gone in the end.
class Weights : public testing::Test {
 protected:
  ~Weights() override { std::remove(path_.c_str()); }

  /// What is said of the file, or nothing.
  std::string Problem() const {
    try {
      PlannerMakerOf(kLearnedPlanner, path_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  void ExpectOneLineWith(const std::string& text) const {
    const std::string problem = Problem();
    EXPECT_EQ(problem.find(path_), 0U) << problem;
    EXPECT_NE(problem.find(text), std::string::npos) << problem;
    EXPECT_EQ(problem.find('\n'), std::string::npos) << problem;
  }

  const std::string path_ = testing::TempDir() + "hv_" +
                            testing::UnitTest::GetInstance()->current_test_info()->name() + ".bin";
};

TEST_F(Weights, OfAPolicyAreRead) {
  RandomNetwork()->ToCheckpoint().Write(path_);
  EXPECT_EQ(Problem(), "");
}

TEST_F(Weights, MustBeThere) { ExpectOneLineWith("No such file"); }

TEST_F(Weights, MustBeWeights) {
  WriteFile(path_, {"a text"});
  ExpectOneLineWith("");
  WriteFile(path_, {std::string(500, 'x')});
  ExpectOneLineWith("is no file of weights");
}

TEST_F(Weights, MustBeWhole) {
  std::string bytes = RandomNetwork()->ToCheckpoint().Serialize();
  bytes[bytes.size() / 2] ^= 1;
  WriteFile(path_, {bytes});
  ExpectOneLineWith("checksum");
  WriteFile(path_, {bytes.substr(0, bytes.size() / 2)});
  ExpectOneLineWith("");
}

TEST_F(Weights, MustBeThoseOfAPolicy) {
  nn::Checkpoint training;
  training.text = ToYaml(TrainConfig());
  training.Write(path_);
  ExpectOneLineWith("holds no policy");
}

TEST_F(Weights, MustFitTheNetwork) {
  nn::Checkpoint checkpoint = RandomNetwork()->ToCheckpoint();
  PolicySettings wider = RandomNetwork()->settings();
  wider.network.width *= 2;
  checkpoint.text = ToYaml(wider);
  checkpoint.Write(path_);
  ExpectOneLineWith("the network needs");
}

TEST(PlannerMakerTest, NeedsNoWeightsForOtherPlanners) {
  EXPECT_NE(PlannerMakerOf("utility", "nowhere")(PlannerInputs()), nullptr);
}

TEST_F(Weights, MakeARobotExploreTheSameWayEachTime) {
  RandomNetwork()->ToCheckpoint().Write(path_);
  std::vector<std::vector<navigation::PlanarPose>> goals;
  for (int i = 0; i < 2; ++i) {
    Exploration exploration({}, PlannerMakerOf(kLearnedPlanner, path_));
    exploration.explorer.Start({});
    const ExplorationResult result = exploration.Run();
    EXPECT_EQ(result.end, ExplorationEnd::kExplored);
    EXPECT_GT(result.progress.explored_m2, 0.97 * FreeArea(TwoRooms(), {}));
    EXPECT_LT(result.progress.travelled_m, 60.0);
    goals.push_back(exploration.goals);
  }
  ASSERT_EQ(goals[0].size(), goals[1].size());
  for (std::size_t i = 0; i < goals[0].size(); ++i) {
    EXPECT_EQ(goals[0][i].position, goals[1][i].position);
  }
}

}  // namespace
}  // namespace hv::explore
