#include "hv_explore_sac/online/online_learner.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "hv_explore_sac/policy/planner_maker.h"
#include "hv_explore_sac/policy/policy_input.h"
#include "policy/small_policy.h"
#include "toy_exploration.h"

namespace hv::explore {
namespace {

namespace fs = std::filesystem;

/// The robot and two goals.
nn::GraphInput TwoGoals() {
  nn::GraphInput input;
  input.features = nn::Matrix<float>::Zero(3, PolicyInput::kFeatures);
  input.features(0, PolicyInput::kIsRobot) = 1.0F;
  for (int goal = 1; goal <= 2; ++goal) {
    input.features(goal, PolicyInput::kIsGoal) = 1.0F;
    input.features(goal, PolicyInput::kPositionX) = goal == 1 ? 0.5F : -0.5F;
  }
  input.positions = input.features.leftCols(2);
  input.globals = Eigen::VectorXf::Zero(PolicyInput::kGlobals);
  input.start = {0, 3, 6, 9};
  input.neighbour = {0, 1, 2, 0, 1, 2, 0, 1, 2};
  input.current = 0;
  input.actions = {1, 2};
  return input;
}

class OnlineLearnerTest : public testing::Test {
 protected:
  OnlineLearnerTest() {
    fs::remove_all(folder_);
    config_.enabled = true;
    config_.folder = folder_ + "/learned";
    config_.cut_after = 8;
    config_.batch = 8;
    config_.capacity = 200;
    config_.value_updates = 10;
    config_.updates = 4;
    fs::create_directories(folder_);
    RandomNetwork()->ToCheckpoint().Write(weights_);
  }
  ~OnlineLearnerTest() override { fs::remove_all(folder_); }

  std::shared_ptr<OnlineLearner> Make() const { return MakeOnlineLearner(config_, weights_); }
  std::string Problem() const {
    try {
      Make();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::string LearnedPath(const std::string& name) const { return config_.folder + "/" + name; }

  const std::string folder_ = testing::TempDir() + "hv_online_" +
                              testing::UnitTest::GetInstance()->current_test_info()->name();
  const std::string weights_ = folder_ + "/policy.bin";
  OnlineLearningConfig config_;
};

TEST_F(OnlineLearnerTest, IsNoneUnlessAskedFor) {
  config_.enabled = false;
  EXPECT_EQ(Make(), nullptr);
  EXPECT_FALSE(fs::exists(config_.folder));
}

TEST_F(OnlineLearnerTest, LearnsWhatIsRewarded) {
  config_.prior_weight = 0.0;
  config_.learning_rate = 3e-3;
  config_.value_updates = 100;
  const nn::GraphInput state = TwoGoals();
  const double before = RandomNetwork()->Choose(state).probability[1];
  {
    const auto learner = Make();
    for (int i = 0; i < 60; ++i) {
      nn::Episode episode;
      const int action = i % 2;
      episode.steps.push_back({state, action, action == 1 ? 1.0F : -1.0F, {}});
      learner->Add(episode);
    }
    for (int i = 0; i < 10; ++i) {
      nn::Episode episode;
      for (int k = 0; k < 8; ++k) episode.steps.push_back({state, 1, 1.0F, {}});
      learner->Add(episode);
    }
    learner->Wait();
    EXPECT_GT(learner->status().updates, 100);
  }
  const double after = PolicyNetwork::Read(LearnedPath("policy.bin"))->Choose(state).probability[1];
  EXPECT_LT(before, 0.8);
  EXPECT_GT(after, 0.95);
}

TEST_F(OnlineLearnerTest, IsNotInTheWayOfTheRobot) {
  const std::string weights = ReadFile(weights_);
  std::vector<std::vector<navigation::PlanarPose>> goals;
  for (const bool learns : {false, true}) {
    config_.enabled = learns;
    const auto learner = Make();
    Exploration exploration({}, PlannerMakerOf(kLearnedPlanner, weights_, learner));
    for (int run = 0; run < 2; ++run) {
      exploration.explorer.Start({});
      exploration.Run();
      if (learner) learner->Wait();
    }
    goals.push_back(exploration.goals);
    if (!learner) continue;
    EXPECT_GT(learner->status().decisions, 5U);
    EXPECT_GT(learner->status().updates, 0);
    EXPECT_EQ(learner->status().problem, "");
  }
  ASSERT_EQ(goals[0].size(), goals[1].size());
  for (std::size_t i = 0; i < goals[0].size(); ++i) {
    EXPECT_EQ(goals[0][i].position, goals[1][i].position);
  }
  EXPECT_EQ(ReadFile(weights_), weights);
  EXPECT_NE(PolicyNetwork::Read(LearnedPath("policy.bin"))->parameters(),
            RandomNetwork()->parameters());
}

TEST_F(OnlineLearnerTest, GoesOnFromItsFolder) {
  nn::Episode episode;
  for (int k = 0; k < 8; ++k) episode.steps.push_back({TwoGoals(), k % 2, 1.0F, {}});
  OnlineLearningStatus before;
  {
    const auto learner = Make();
    learner->Add(episode);
    learner->Wait();
    before = learner->status();
  }
  EXPECT_EQ(before.decisions, 8U);
  EXPECT_EQ(before.updates, 4 * 8 - 10);
  const auto learner = Make();
  EXPECT_EQ(learner->status().decisions, before.decisions);
  EXPECT_EQ(learner->status().updates, before.updates);
  learner->Add(episode);
  learner->Wait();
  EXPECT_EQ(learner->status().decisions, 16U);
  EXPECT_EQ(learner->status().updates, before.updates + 4 * 8);
}

TEST_F(OnlineLearnerTest, RemembersWhatWasAddedLast) {
  nn::Episode episode;
  for (int k = 0; k < 8; ++k) episode.steps.push_back({TwoGoals(), k % 2, 1.0F, {}});
  {
    const auto learner = Make();
    for (int i = 0; i < 5; ++i) learner->Add(episode);
  }
  EXPECT_EQ(Make()->status().decisions, 40U);
}

TEST_F(OnlineLearnerTest, SaysWhatIsWrongWithItsFolder) {
  Make();
  for (const char* name : {"learner.bin", "replay.bin"}) {
    const std::string path = LearnedPath(name);
    const std::string whole = ReadFile(path);
    WriteFile(path, {whole.substr(0, whole.size() / 2)});
    EXPECT_NE(Problem(), "") << name;
    WriteFile(path, {whole});
    EXPECT_EQ(Problem(), "") << name;
  }
  config_.folder = weights_;  // a file
  EXPECT_EQ(Problem().find(weights_), 0U);
}

TEST_F(OnlineLearnerTest, OfAnotherPolicyIsNotTakenUp) {
  Make();
  PolicySettings wider = RandomNetwork()->settings();
  wider.network.width *= 2;
  const nn::Network<float> network(wider.network, PolicyNetwork::Shape());
  PolicyNetwork(wider, network.layout().Initial(1)).ToCheckpoint().Write(weights_);
  EXPECT_NE(Problem().find("another kind of policy"), std::string::npos) << Problem();
}

TEST_F(OnlineLearnerTest, GoesOnWhenItCannotSave) {
  const auto learner = Make();
  fs::remove_all(config_.folder);
  nn::Episode episode;
  for (int k = 0; k < 8; ++k) episode.steps.push_back({TwoGoals(), k % 2, 1.0F, {}});
  learner->Add(episode);
  learner->Wait();
  EXPECT_NE(learner->status().problem.find(config_.folder), std::string::npos);
  fs::create_directories(config_.folder);
  learner->Add(episode);
  learner->Wait();
  EXPECT_EQ(learner->status().problem, "");
}

}  // namespace
}  // namespace hv::explore
