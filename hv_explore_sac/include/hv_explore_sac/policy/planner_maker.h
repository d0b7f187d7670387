#pragma once

#include <functional>
#include <memory>
#include <string>

#include "hv_explore_sac/online/online_learner.h"
#include "hv_explore_sac/planner.h"

namespace hv::explore {

/// Makes the planner of a name, the learned one (kLearnedPlanner) too, as Explorer takes it. Its
/// weights are read here, once for all planners made, and not for other names. A learner, which may
/// be null, is handed what comes of the decisions of the learned one. Throws InputError for weights
/// that cannot be used. What is returned may be called from several threads.
std::function<std::unique_ptr<Planner>(const PlannerInputs&)> PlannerMakerOf(
    const std::string& name, const std::string& weights,
    std::shared_ptr<OnlineLearner> learner = nullptr);

}  // namespace hv::explore
