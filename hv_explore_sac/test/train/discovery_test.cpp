#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hv_explore_sac/exploration_run.h"
#include "hv_explore_sac/policy/policy_network.h"
#include "hv_explore_sac/policy/policy_planner.h"
#include "hv_explore_sac/train/fine_tuner.h"

namespace hv::explore {
namespace {

/// A fork whose short arm should be driven into first: whoever begins with the long one comes back
/// all of it. At the fork both arms look the same, but for the border of the map.
ExplorationMap Fork(bool mirrored) {
  const std::vector<std::string> rows = {
      "############################################",  //
      "##........................................##",  //
      "##........................................##",  //
      "##########..################################",  //
      "##########..################################",  //
      "##########S.################################",  //
      "############################################",  //
  };
  std::string tiles;
  std::size_t start = 0;
  for (std::string row : rows) {
    if (mirrored) row = std::string(row.rbegin(), row.rend());
    if (row.find('S') != std::string::npos) start = row.find('S');
    tiles += row + "\n";
  }
  return ParseTiles("map fork " + std::to_string(16 * start + 8) + " 88\n" + tiles, "test")[0];
}

/// Drives to any of the goals among which a policy chooses.
class RandomPlanner : public Planner {
 public:
  explicit RandomPlanner(unsigned seed) : builder_(PolicyConfig()), random_(seed) {}

  Decision Choose(const Observation& observation, const ExplorationModel& model) override {
    builder_.Build(observation, model, std::nullopt, input_);
    const int goal = builder_.goals()[random_() % builder_.goals().size()].node;
    return {observation.FirstHopTo(goal), goal};
  }

 private:
  PolicyInput builder_;
  std::mt19937_64 random_;
  nn::GraphInput input_;
};

/// Discrete SAC from nothing: no labels, no policy to begin with, values that know nothing.
class DiscoveryTest : public testing::Test {
 protected:
  DiscoveryTest() : maps_{Fork(false), Fork(true)} {
    inputs_.exploration.simulation.max_steps = 100;
    inputs_.sensor = &sensor_;
    config_.episodes = 4;
    config_.updates = 80;
    config_.batch = 32;
    config_.first_episodes = 20;
    config_.value_updates = 0;
    nn::NetworkConfig& network = learning_.actor;
    network.width = 16;
    network.heads = 2;
    network.feed_forward = 32;
    network.encoder_layers = 1;
    network.pyramid_levels = 0;
    network.memory = 0;
    learning_.critic = network;
    learning_.actor_optimiser.learning_rate = 2e-3;
    learning_.critic_optimiser.learning_rate = 2e-3;
    learning_.soft_update = 0.05;
    learning_.temperature = 0.3;
    learning_.tune_temperature = false;
    learning_.seed = 2;
  }

  /// Mean over both maps, without a loop guard [cells].
  double Travel(const std::string& planner, const PlannerFactory& make_planner) const {
    EvaluationConfig config;
    config.exploration = inputs_.exploration;
    config.guard.enabled = false;
    config.make_planner = make_planner;
    double sum = 0.0;
    for (const ExplorationMap& map : maps_) {
      sum += RunExploration(map, planner, sensor_, config).travel;
    }
    return sum / static_cast<double>(maps_.size());
  }
  double TravelOf(const Eigen::VectorXf& actor) const {
    const auto network = std::make_shared<const PolicyNetwork>(
        PolicySettings{inputs_.policy, learning_.actor}, actor);
    return Travel("sac", [network](const std::string&, const PlannerInputs&) {
      return std::make_unique<PolicyPlanner>(network);
    });
  }
  double RandomTravel() const {
    constexpr unsigned kTrials = 10;
    double sum = 0.0;
    for (unsigned seed = 1; seed <= kTrials; ++seed) {
      sum += Travel("random", [seed](const std::string&, const PlannerInputs&) {
        return std::make_unique<RandomPlanner>(seed);
      });
    }
    return sum / kTrials;
  }

  const std::vector<ExplorationMap> maps_;
  const RaySensor sensor_{SimulationConfig()};
  FineTuneConfig config_;
  EpisodeInputs inputs_;
  nn::SacConfig learning_;
  Ranks ranks_;
};

TEST_F(DiscoveryTest, LearnsFromRewardsAloneWhichArmComesFirst) {
  constexpr std::uint64_t kCycles = 20;
  FineTuner tuner(config_, inputs_, learning_, {&maps_[0], &maps_[1]}, ranks_);
  const Eigen::VectorXf untrained = tuner.sac().actor_parameters();
  tuner.Begin(untrained, 1);
  for (std::uint64_t cycle = 1; cycle <= kCycles; ++cycle) tuner.Cycle(100 * cycle);

  const double learned = TravelOf(tuner.sac().actor_parameters());
  EXPECT_LT(learned, 1.05 * Travel("oracle", MakePlanner));  // which knows the map
  EXPECT_LT(learned, 0.7 * Travel("utility", MakePlanner));
  EXPECT_LT(learned, 0.85 * TravelOf(untrained));
  EXPECT_LT(learned, 0.85 * RandomTravel());
}

}  // namespace
}  // namespace hv::explore
