#include "hv_explore_sac/train/fine_tuner.h"

#include <gtest/gtest.h>

#include "hv_explore_sac/policy/policy_network.h"
#include "random_maps.h"

namespace hv::explore {
namespace {

class FineTunerTest : public testing::Test {
 protected:
  FineTunerTest() : sensor_(ExplorationConfig().simulation) {
    for (unsigned seed = 1; seed <= 3; ++seed) maps_.push_back(RandomMap(seed));
    inputs_.sensor = &sensor_;
    config_.episodes = 3;
    config_.updates = 4;
    config_.batch = 8;
    config_.capacity = 60;
    config_.first_episodes = 3;
    config_.value_updates = 5;
    nn::NetworkConfig& network = learning_.actor;
    network.width = 8;
    network.heads = 2;
    network.feed_forward = 8;
    network.encoder_layers = 1;
    network.pyramid_levels = 0;
    network.memory = 4;
    learning_.critic = network;
  }

  std::unique_ptr<FineTuner> Make() {
    std::vector<const ExplorationMap*> maps;
    for (const ExplorationMap& map : maps_) maps.push_back(&map);
    return std::make_unique<FineTuner>(config_, inputs_, learning_, maps, ranks_);
  }
  Eigen::VectorXf RandomActor() const {
    return nn::Network<float>(learning_.actor, PolicyNetwork::Shape()).layout().Initial(5);
  }

  RaySensor sensor_;
  std::vector<ExplorationMap> maps_;
  FineTuneConfig config_;
  EpisodeInputs inputs_;
  nn::SacConfig learning_;
  Ranks ranks_;
};

TEST_F(FineTunerTest, GoesOnFromItsFilesAsIfNothingHadHappened) {
  const auto whole = Make();
  whole->Begin(RandomActor(), 1);
  whole->Cycle(2);
  const std::string sac = testing::TempDir() + "sac.bin";
  const std::string replay = testing::TempDir() + "replay.bin";
  whole->Save(sac, replay);
  const auto resumed = Make();
  resumed->Load(sac, replay);
  EXPECT_EQ(resumed->states(), whole->states());
  EXPECT_EQ(resumed->Cycle(3).critic_loss, whole->Cycle(3).critic_loss);
  EXPECT_EQ(resumed->sac().actor_parameters(), whole->sac().actor_parameters());
  EXPECT_EQ(resumed->sac().critic_parameters(), whole->sac().critic_parameters());
}

TEST_F(FineTunerTest, EpisodesEndWithTheMapAndRewardsAddUp) {
  const auto tuner = Make();
  const Chooser choose = [&](const nn::GraphInput& input) {
    return tuner->sac().Policy(nn::BuildSample(input, 0));
  };
  const nn::Episode episode = RunEpisode(maps_[0], inputs_, choose, 1);
  ASSERT_TRUE(episode.done);
  double sum = 0.0;
  for (const nn::EpisodeStep& step : episode.steps) sum += static_cast<double>(step.reward);
  EXPECT_NEAR(WithReturns(episode, 1.0).steps.front().reward, sum, 1e-3 * std::abs(sum));
  EXPECT_EQ(WithReturns(episode, 0.0).steps.front().reward, episode.steps.front().reward);
  EXPECT_GT(episode.steps.back().reward, inputs_.reward.completion / 2);
}

}  // namespace
}  // namespace hv::explore
