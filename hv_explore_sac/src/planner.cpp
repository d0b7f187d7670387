#include "hv_explore_sac/planner.h"

#include <cmath>

#include "branch_planner.h"
#include "goal_planner.h"
#include "hv_core/error.h"
#include "oracle_planner.h"
#include "tour_planner.h"

namespace hv::explore {

void PlannerConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("utility_decay", utility_decay, "of the utility with the distance [1/cells]");
  visitor.Field("branch_decay", branch_decay, "of the utility along a branch [1/cells]");
  visitor.Field("keep_goal", keep_goal, "how many times better another goal must be");
  visitor.Field("tour_samples", tour_samples, "set covers that are tried for each tour");
  visitor.Field("oracle_trials", oracle_trials,
                "changes of its route that the oracle tries at each decision");
}

void PlannerConfig::Validate(ConfigProblems& problems) const {
  problems.Require(utility_decay >= 0.0, "planner.utility_decay", "must not be negative");
  problems.Require(branch_decay >= 0.0, "planner.branch_decay", "must not be negative");
  problems.Require(keep_goal >= 1.0, "planner.keep_goal", "must be at least 1");
  problems.Require(tour_samples >= 1, "planner.tour_samples", "must be at least 1");
  problems.Require(oracle_trials >= 1, "planner.oracle_trials", "must be at least 1");
}

const std::vector<std::string>& PlannerNames() {
  static const std::vector<std::string> names{"nearest", "utility", "ratio",
                                              "tour",    "branch",  "oracle"};
  return names;
}

std::unique_ptr<Planner> MakePlanner(const std::string& name, const PlannerInputs& inputs) {
  const PlannerConfig& config = inputs.planner;
  if (name == "nearest") {
    const auto score = [](const Observation::Node& node) {
      return 1.0 / (1.0 + static_cast<double>(node.distance));
    };
    return std::make_unique<GoalPlanner>(score, config.keep_goal);
  }
  if (name == "utility") {
    const auto score = [decay = config.utility_decay](const Observation::Node& node) {
      return node.utility * std::exp(-decay * static_cast<double>(node.distance));
    };
    return std::make_unique<GoalPlanner>(score, config.keep_goal);
  }
  if (name == "ratio") {
    const auto score = [](const Observation::Node& node) {
      return static_cast<double>(node.utility) / static_cast<double>(node.distance);
    };
    return std::make_unique<GoalPlanner>(score, config.keep_goal);
  }
  if (name == "tour") return std::make_unique<TourPlanner>(config);
  if (name == "branch") return std::make_unique<BranchPlanner>(config);
  if (name == "oracle") return std::make_unique<OraclePlanner>(inputs);
  std::string known;
  for (const std::string& each : PlannerNames()) known += (known.empty() ? "" : ", ") + each;
  throw InputError("unknown planner `" + name + "`; there are " + known);
}

}  // namespace hv::explore
