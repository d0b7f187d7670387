#include "hv_explore_sac/policy/policy_config.h"

#include "hv_explore_sac/policy/goal_tours.h"

namespace hv::explore {

void PolicyConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("most_goals", most_goals, "among which the policy chooses");
  visitor.Field("goal_decay", goal_decay,
                "of the utility that ranks goals [1/cells of the benchmark]");
  visitor.Field("fresh_share", fresh_share,
                "of a goal's frontier points that no goal before it observes");
  visitor.Field("ways", ways, "the network reads the viewpoints on the ways to the goals too");
  visitor.Field("keep_goal", keep_goal, "advantage of the goal it has [log preference]");
}

void PolicyConfig::Validate(ConfigProblems& problems) const {
  problems.Require(most_goals >= 1 && most_goals <= GoalTours::kMostGoals, "policy.most_goals",
                   "must be within 1 and " + std::to_string(GoalTours::kMostGoals));
  problems.Require(goal_decay >= 0.0, "policy.goal_decay", "must not be negative");
  problems.Require(fresh_share > 0.0 && fresh_share <= 1.0, "policy.fresh_share",
                   "must be above 0 and at most 1");
  problems.Require(keep_goal >= 0.0, "policy.keep_goal", "must not be negative");
}

}  // namespace hv::explore
