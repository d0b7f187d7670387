#include "hv_explore_sac/policy/policy_scale.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "hv_explore_sac/explorer_config.h"
#include "hv_explore_sac/policy/policy_planner.h"
#include "random_states.h"
#include "small_policy.h"

namespace hv::explore {
namespace {

TEST(PolicyScaleTest, IsOneInTheBenchmark) {
  const PolicyScale scale{ExplorationConfig()};
  EXPECT_EQ(scale.unit, 1.0F);
  EXPECT_EQ(scale.point, 1.0F);
}

TEST(PolicyScaleTest, OfARobotFollowsItsViewsAndItsBlocks) {
  ExplorerConfig config;
  const PolicyScale coarse(config.InCells(0.1));
  EXPECT_FLOAT_EQ(coarse.unit, 1.0F);
  EXPECT_FLOAT_EQ(coarse.point, 0.5F);
  // The size of cells changes nothing but the number of cells in a unit.
  const PolicyScale fine(config.InCells(0.05));
  EXPECT_FLOAT_EQ(fine.unit, 2.0F);
  EXPECT_FLOAT_EQ(fine.point, 0.5F);
  // Goals are ranked as `utility` ranks them.
  EXPECT_NEAR(PolicyConfig().goal_decay / static_cast<double>(fine.unit),
              config.PlannerInCells(0.05).utility_decay, 1e-9);
  config.places.view_range_m *= 2.0;
  EXPECT_FLOAT_EQ(PolicyScale(config.InCells(0.1)).unit, 2.0F);
  EXPECT_FLOAT_EQ(PolicyScale(config.InCells(0.1)).point, 0.25F);
}

/// Lattices that stay in place when cells become finer.
ExplorationConfig Finer(int factor, int block) {
  ExplorationConfig config;
  config.frontier.block = block * factor;
  config.viewpoint.spacing_x = 22.0 * factor;
  config.viewpoint.spacing_y = 16.0 * factor;
  config.viewpoint.view_range *= factor;
  return config;
}

Belief FinerBelief(const Belief& belief, int factor) {
  Belief finer(belief.width() * factor, belief.height() * factor);
  for (int y = 0; y < finer.height(); ++y) {
    for (int x = 0; x < finer.width(); ++x) {
      const Eigen::Vector2i cell(x, y);
      finer.Set(finer.IndexOf(cell), belief.At(Eigen::Vector2i(cell / factor)));
    }
  }
  return finer;
}

/// What is known in a state, in cells that are finer by a factor.
class FinerState {
 public:
  FinerState(const RandomState& state, int factor, int block = 4)
      : factor_(factor),
        model_(Finer(factor, block), state.map.width * factor, state.map.height * factor) {
    const ExplorationModel& before = state.environment.model();
    model_.belief() = FinerBelief(before.belief(), factor);
    std::vector<Eigen::Vector2i> stood;
    for (int viewpoint = 0; viewpoint < before.graph().size(); ++viewpoint) {
      if (!before.graph().Visited(viewpoint)) continue;
      stood.emplace_back(before.graph().CellOf(viewpoint) * factor);
    }
    model_.Recall(stood, 0.0);
    model_.Update(before.graph().CellOf(before.robot()) * factor);
    model_.Observe(observation_);
    builder_.Build(observation_, model_, std::nullopt, input_);
  }

  const nn::GraphInput& input() const { return input_; }
  const std::vector<Goal>& goals() const { return builder_.goals(); }
  /// In cells that are not finer.
  Eigen::Vector2i CellOf(int node) const {
    return model_.graph().CellOf(observation_.node(node).viewpoint) / factor_;
  }
  std::vector<std::pair<int, int>> GoalCells() const {
    std::vector<std::pair<int, int>> cells;
    for (const Goal& goal : goals()) {
      cells.emplace_back(CellOf(goal.node).x(), CellOf(goal.node).y());
    }
    return cells;
  }
  Eigen::Vector2i Choice() const {
    PolicyPlanner planner(RandomNetwork());
    return CellOf(planner.Choose(observation_, model_).goal);
  }

 private:
  int factor_;
  ExplorationModel model_;
  Observation observation_;
  PolicyInput builder_{PolicyConfig()};
  nn::GraphInput input_;
};

class FinerCells : public testing::TestWithParam<unsigned> {};

TEST_P(FinerCells, ChangeNeitherGoalsNorWhatIsReadNorTheChoice) {
  const RandomState state(GetParam());
  if (!state.running()) GTEST_SKIP();
  const FinerState coarse(state, 1);
  const FinerState fine(state, 2);
  ASSERT_FALSE(coarse.goals().empty());
  ASSERT_EQ(fine.GoalCells(), coarse.GoalCells());
  // Lines past corners cross other cells when cells are finer, so that a point or two is seen or
  // not and a way is a little longer.
  constexpr float kCorners = 0.1F;
  const nn::GraphInput& a = coarse.input();
  const nn::GraphInput& b = fine.input();
  EXPECT_LT((b.features - a.features).cwiseAbs().maxCoeff(), kCorners);
  EXPECT_LT((b.history - a.history).cwiseAbs().maxCoeff(), kCorners);
  EXPECT_LT((b.globals - a.globals).cwiseAbs().maxCoeff(), kCorners);
  EXPECT_EQ(b.positions, a.positions);
  EXPECT_EQ(fine.Choice(), coarse.Choice());
}

INSTANTIATE_TEST_SUITE_P(RandomStates, FinerCells, testing::Range(1U, 13U));

TEST(PolicyScaleTest, FinerBlocksShowAsMuchOfTheBorder) {
  constexpr int kPoints = 3;  // of the globals: fresh points of all goals
  float coarse = 0.0F;
  float fine = 0.0F;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const RandomState state(seed);
    if (!state.running()) continue;
    coarse += FinerState(state, 1, 4).input().globals[kPoints];
    fine += FinerState(state, 1, 2).input().globals[kPoints];
  }
  EXPECT_NEAR(fine / coarse, 1.0F, 0.1F);
}

}  // namespace
}  // namespace hv::explore
