#include "hv_explore_sac/online/learning_planner.h"

#include <utility>

namespace hv::explore {

LearningPlanner::LearningPlanner(std::shared_ptr<const PolicyNetwork> network,
                                 std::shared_ptr<OnlineLearner> learner)
    : planner_(std::move(network)),
      learner_(std::move(learner)),
      recorder_(learner_->config().reward, learner_->config().cut_after) {}

LearningPlanner::~LearningPlanner() { HandOver(recorder_.BreakOff()); }

Decision LearningPlanner::Choose(const Observation& observation, const ExplorationModel& model) {
  const Decision decision = planner_.Choose(observation, model);
  HandOver(recorder_.Decide(model, planner_.input(), planner_.choice()));
  return decision;
}

void LearningPlanner::End(const ExplorationModel& model) { HandOver(recorder_.End(model)); }

void LearningPlanner::HandOver(std::optional<nn::Episode> episode) {
  if (episode) learner_->Add(std::move(*episode));
}

}  // namespace hv::explore
