#include "hv_explore_sac/nn/replay_buffer.h"

#include <map>
#include <stdexcept>

#include <gtest/gtest.h>

#include "sample_graphs.h"

namespace hv::explore::nn {
namespace {

/// States that carry their number as a feature.
GraphInput Numbered(int number) {
  GraphInput graph = RandomGraph(static_cast<std::uint32_t>(number), 12, 3, 4);
  graph.features(0, 0) = static_cast<float>(number);
  return graph;
}

int NumberOf(const GraphSample& sample) { return static_cast<int>(sample.features(0, 0)); }

Episode MakeEpisode(int first, int steps, bool done) {
  Episode episode;
  for (int i = 0; i < steps; ++i) {
    episode.steps.push_back(
        {Numbered(first + i), i % 3, static_cast<float>(first + i), Eigen::VectorXf()});
  }
  episode.done = done;
  if (!done) episode.last = Numbered(first + steps);
  return episode;
}

TEST(PackedGraph, GivesBackWhatItGot) {
  const GraphInput graph = RandomGraph(3, 300, 10, 19, 32);
  const PackedGraph packed(graph);
  const GraphInput back = packed.Unpack();
  EXPECT_EQ(back.start, graph.start);
  EXPECT_EQ(back.neighbour, graph.neighbour);
  EXPECT_EQ(back.actions, graph.actions);
  EXPECT_EQ(back.current, graph.current);
  EXPECT_EQ(back.positions, graph.positions);
  EXPECT_EQ(back.globals, graph.globals);
  EXPECT_LT((back.features - graph.features).cwiseAbs().maxCoeff(), 2e-3F);
  EXPECT_LT((back.history - graph.history).cwiseAbs().maxCoeff(), 2e-3F);
  EXPECT_LT(packed.bytes(), 25000U);
}

TEST(ReplayBuffer, JoinsConsecutiveStates) {
  ReplayBuffer buffer(100, 1);
  buffer.Add(MakeEpisode(0, 3, true));
  buffer.Add(MakeEpisode(10, 2, false));
  EXPECT_EQ(buffer.states(), 6U);
  EXPECT_EQ(buffer.transitions(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    const Transition transition = buffer.Get(i);
    EXPECT_EQ(transition.done, i == 2);
    EXPECT_EQ(transition.reward, static_cast<float>(NumberOf(transition.state)));
    if (!transition.done) {
      EXPECT_EQ(NumberOf(transition.next), NumberOf(transition.state) + 1);
    }
    EXPECT_EQ(transition.state.levels.size(), 2U);
  }
}

/// Whatever was overwritten, a transition never leads into another episode.
TEST(ReplayBuffer, OverwritesTheOldestAndStaysConsistent) {
  ReplayBuffer buffer(17, 0);
  std::mt19937_64 random(1);
  int next = 0;
  for (int i = 0; i < 40; ++i) {
    const int steps = 1 + static_cast<int>(random() % 6);
    buffer.Add(MakeEpisode(next, steps, random() % 2 == 0));
    next += steps + 5;
    EXPECT_LE(buffer.states(), 17U);
    for (const std::size_t position : buffer.Draw(20, random)) {
      const Transition transition = buffer.Get(position);
      EXPECT_EQ(transition.reward, static_cast<float>(NumberOf(transition.state)));
      if (!transition.done) {
        EXPECT_EQ(NumberOf(transition.next), NumberOf(transition.state) + 1);
      }
      if (buffer.states() == 17U) {
        EXPECT_GT(NumberOf(transition.state), next - 17 * 11);
      }
    }
  }
}

TEST(ReplayBuffer, DrawsUniformlyAndBySeed) {
  ReplayBuffer buffer(100, 0);
  std::mt19937_64 random(4);
  EXPECT_TRUE(buffer.Draw(5, random).empty());
  buffer.Add(MakeEpisode(0, 10, true));
  std::mt19937_64 same = random;
  const std::vector<std::size_t> drawn = buffer.Draw(5000, random);
  EXPECT_EQ(drawn, buffer.Draw(5000, same));
  std::map<std::size_t, int> counts;
  for (const std::size_t position : drawn) ++counts[position];
  EXPECT_EQ(counts.size(), 10U);
  for (const auto& [position, count] : counts) EXPECT_NEAR(count, 500, 110) << position;
}

}  // namespace
}  // namespace hv::explore::nn
