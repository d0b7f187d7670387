#include "hv_explore_sac/nn/sac.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "sample_graphs.h"

namespace hv::explore::nn {
namespace {

/// A maze of seven places with a dead end and a detour, and a goal. A step costs its length.
///
///     0 - 1 - 2 - 3       goal 6: by 2 - 5 - 6 it is near, by 4 it is far
///         |   |
///         4   5 - 6       4 - 6 is one long edge
class Maze {
 public:
  static constexpr int kPlaces = 7;
  static constexpr int kGoal = 6;

  struct Step {
    int place;
    float reward;
    bool done;
  };

  GraphInput At(int place) const {
    GraphInput graph;
    graph.features = Matrix<float>::Zero(kPlaces, 3);
    graph.positions.resize(kPlaces, 2);
    for (int i = 0; i < kPlaces; ++i) {
      graph.positions.row(i) = positions_[static_cast<std::size_t>(i)];
      for (const int other : neighbours_[static_cast<std::size_t>(i)]) {
        graph.neighbour.push_back(other);
      }
      graph.start.push_back(static_cast<std::int32_t>(graph.neighbour.size()));
    }
    graph.features(place, 0) = 1.0F;
    graph.features(kGoal, 1) = 1.0F;
    graph.features.col(2) = 0.3F * (graph.positions.col(0).array() - graph.positions(place, 0));
    graph.current = place;
    const std::vector<int>& ways = neighbours_[static_cast<std::size_t>(place)];
    graph.actions.assign(ways.begin(), ways.end());
    return graph;
  }

  Step Take(int place, Index action) const {
    const int to = neighbours_[static_cast<std::size_t>(place)][static_cast<std::size_t>(action)];
    const bool done = to == kGoal;
    return {to, (done ? 1.0F : 0.0F) - 0.1F * Length(place, to), done};
  }

  int WaysFrom(int place) const {
    return static_cast<int>(neighbours_[static_cast<std::size_t>(place)].size());
  }

  /// Largest discounted return from each place, by value iteration.
  std::array<double, kPlaces> Optimum(double discount) const {
    std::array<double, kPlaces> value{};
    for (int sweep = 0; sweep < 100; ++sweep) {
      for (int place = 0; place < kGoal; ++place) {
        double best = -1e9;
        for (int way = 0; way < WaysFrom(place); ++way) {
          const Step step = Take(place, way);
          const double next = step.done ? 0.0 : value[static_cast<std::size_t>(step.place)];
          best = std::max(best, static_cast<double>(step.reward) + discount * next);
        }
        value[static_cast<std::size_t>(place)] = best;
      }
    }
    return value;
  }

 private:
  float Length(int a, int b) const {
    return (positions_[static_cast<std::size_t>(a)] - positions_[static_cast<std::size_t>(b)])
        .norm();
  }

  const std::vector<Eigen::RowVector2f> positions_ = {{0, 0},  {1, 0},  {2, 0}, {3, 0},
                                                      {1, -4}, {2, -1}, {3, -1}};
  const std::vector<std::vector<int>> neighbours_ = {{1},    {0, 2, 4}, {1, 3, 5}, {2},
                                                     {1, 6}, {2, 6},    {4, 5}};
};

SacConfig MazeConfig() {
  SacConfig config;
  config.actor = config.critic = {16, 2, 32, 2, 1, 8};
  config.actor_optimiser.learning_rate = config.critic_optimiser.learning_rate = 2e-3;
  config.actor_optimiser.warmup_steps = config.critic_optimiser.warmup_steps = 20;
  config.discount = 0.95;
  config.soft_update = 0.05;
  config.temperature = 0.1;
  config.target_entropy = 0.1;
  config.temperature_rate = 5e-3;
  return config;
}

/// Plays one episode by the present policy into `buffer`.
void Play(const Maze& maze, const Sac& sac, std::mt19937_64& random, ReplayBuffer& buffer) {
  constexpr int kMostSteps = 12;
  Episode episode;
  episode.done = false;
  int place = static_cast<int>(random() % Maze::kGoal);
  for (int i = 0; i < kMostSteps && !episode.done; ++i) {
    const GraphInput state = maze.At(place);
    const double uniform = static_cast<double>(random() >> 11U) * 0x1p-53;
    const Index action = sac.Policy(BuildSample(state, 1)).Draw(uniform);
    const Maze::Step step = maze.Take(place, action);
    episode.steps.push_back({state, static_cast<int>(action), step.reward, {}});
    episode.done = step.done;
    place = step.place;
  }
  if (!episode.done) episode.last = maze.At(place);
  buffer.Add(episode);
}

/// Discounted return of the greedy policy; ends after as many steps as any sane way takes.
double GreedyReturn(const Maze& maze, const Sac& sac, int place, double discount) {
  double sum = 0.0;
  double weight = 1.0;
  for (int i = 0; i < 10; ++i) {
    const Maze::Step step = maze.Take(place, sac.Policy(BuildSample(maze.At(place), 1)).Best());
    sum += weight * static_cast<double>(step.reward);
    if (step.done) return sum;
    weight *= discount;
    place = step.place;
  }
  return -1e9;
}

TEST(Sac, SolvesAMazeFromScratch) {
  const Maze maze;
  const SacConfig config = MazeConfig();
  Sac sac(config, {3, 0, 1}, 0);
  ReplayBuffer buffer(2000, config.actor.pyramid_levels);
  std::mt19937_64 random(1);
  for (int i = 0; i < 20; ++i) Play(maze, sac, random, buffer);
  SacStatistics statistics;
  for (int update = 0; update < 600; ++update) {
    if (update % 2 == 0) Play(maze, sac, random, buffer);
    const std::vector<std::size_t> drawn = buffer.Draw(32, random);
    statistics = sac.Update(drawn.size(), [&](std::size_t i) { return buffer.Get(drawn[i]); });
  }
  const auto optimum = maze.Optimum(config.discount);
  for (int place = 0; place < Maze::kGoal; ++place) {
    const double best = optimum[static_cast<std::size_t>(place)];
    EXPECT_NEAR(GreedyReturn(maze, sac, place, config.discount), best, 1e-6) << place;
    const GraphSample sample = BuildSample(maze.At(place), 1);
    const Index action = sac.Policy(sample).Best();
    EXPECT_NEAR(static_cast<double>(sac.Values(sample).row(action).mean()), best, 0.15) << place;
  }
  EXPECT_LT(statistics.temperature, 0.1);
  EXPECT_LT(std::abs(statistics.excess_entropy), 0.25);
}

/// Imitation alone: labels that send the robot backwards.
TEST(Sac, FollowsLabels) {
  const Maze maze;
  Sac sac(MazeConfig(), {3, 0, 1}, 0);
  const auto fetch = [&](std::size_t i) {
    Transition transition;
    const int place = static_cast<int>(i % Maze::kGoal);
    transition.state = BuildSample(maze.At(place), 1);
    transition.label = Eigen::VectorXf::Unit(maze.WaysFrom(place), 0);
    return transition;
  };
  double loss = 0.0;
  for (int update = 0; update < 150; ++update) loss = sac.Imitate(12, fetch);
  EXPECT_LT(loss, 0.05);
  for (int place = 0; place < Maze::kGoal; ++place) {
    EXPECT_EQ(sac.Policy(BuildSample(maze.At(place), 1)).Best(), 0) << place;
  }
}

TEST(Sac, RegressesValues) {
  const Maze maze;
  Sac sac(MazeConfig(), {3, 0, 1}, 0);
  const auto fetch = [&](std::size_t i) {
    Transition transition;
    const int place = static_cast<int>(i % Maze::kGoal);
    transition.state = BuildSample(maze.At(place), 1);
    transition.reward = 0.3F * static_cast<float>(place) - 0.5F;
    return transition;
  };
  double loss = 0.0;
  for (int update = 0; update < 300; ++update) loss = sac.RegressValues(12, fetch);
  EXPECT_LT(loss, 0.01);
}

/// Without rewards, the prior alone says where to go.
TEST(Sac, StaysNearThePrior) {
  const Maze maze;
  SacConfig config = MazeConfig();
  config.prior_weight = 100.0;
  Sac sac(config, {3, 0, 1}, 0);
  sac.KeepPrior();
  const ActionDistribution before = sac.Policy(BuildSample(maze.At(2), 1));
  const auto fetch = [&](std::size_t i) {
    Transition transition;
    transition.state = BuildSample(maze.At(2), 1);
    transition.action = static_cast<int>(i % 3);
    transition.reward = i % 3 == 0 ? 1.0F : -1.0F;
    transition.done = true;
    return transition;
  };
  for (int update = 0; update < 60; ++update) sac.Update(12, fetch);
  const ActionDistribution after = sac.Policy(BuildSample(maze.At(2), 1));
  EXPECT_LT((after.probability - before.probability).cwiseAbs().maxCoeff(), 0.05F);
}

TEST(Sac, GoesOnFromACheckpointAsIfNothingHappened) {
  const Maze maze;
  const auto fetch = [&](std::size_t i) {
    Transition transition;
    transition.state = BuildSample(maze.At(static_cast<int>(i % Maze::kGoal)), 1);
    transition.next = BuildSample(maze.At(static_cast<int>((i + 1) % Maze::kGoal)), 1);
    transition.reward = static_cast<float>(i);
    return transition;
  };
  Sac sac(MazeConfig(), {3, 0, 1}, 0);
  sac.KeepPrior();
  for (int update = 0; update < 3; ++update) sac.Update(6, fetch);
  Checkpoint saved;
  sac.Save(saved);
  SacConfig other_seed = MazeConfig();
  other_seed.seed = 9;
  Sac resumed(other_seed, {3, 0, 1}, 0);
  resumed.Load(Checkpoint::Parse(saved.Serialize(), "memory"));
  EXPECT_EQ(resumed.updates(), 3);
  for (int update = 0; update < 3; ++update) {
    sac.Update(6, fetch);
    resumed.Update(6, fetch);
  }
  EXPECT_EQ(resumed.actor_parameters(), sac.actor_parameters());
  EXPECT_EQ(resumed.critic_parameters(), sac.critic_parameters());
  EXPECT_EQ(resumed.temperature(), sac.temperature());
}

TEST(SacConfig, ListsProblemsWithTheirPlace) {
  SacConfig config;
  config.actor.heads = 7;
  config.critic_optimiser.learning_rate = 0.0;
  config.discount = 1.0;
  ConfigProblems problems;
  config.Validate(problems);
  EXPECT_EQ(problems.lines(),
            (std::vector<std::string>{"actor.heads: must divide the width",
                                      "critic_optimiser.learning_rate: must be positive",
                                      "discount: must be within 0 and 1"}));
  ConfigProblems none;
  SacConfig().Validate(none);
  EXPECT_TRUE(none.lines().empty());
}

TEST(SacConfig, PriorFades) {
  SacConfig config;
  config.prior_weight = 0.8;
  config.prior_half_life = 100.0;
  EXPECT_DOUBLE_EQ(config.PriorWeight(0), 0.8);
  EXPECT_DOUBLE_EQ(config.PriorWeight(200), 0.2);
}

}  // namespace
}  // namespace hv::explore::nn
