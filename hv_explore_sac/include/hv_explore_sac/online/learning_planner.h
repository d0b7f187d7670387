#pragma once

#include <memory>

#include "hv_explore_sac/online/experience.h"
#include "hv_explore_sac/online/online_learner.h"
#include "hv_explore_sac/policy/policy_planner.h"

namespace hv::explore {

/// Decides as PolicyPlanner does, and hands what comes of it to a learner.
class LearningPlanner : public Planner {
 public:
  LearningPlanner(std::shared_ptr<const PolicyNetwork> network,
                  std::shared_ptr<OnlineLearner> learner);
  ~LearningPlanner() override;

  Decision Choose(const Observation& observation, const ExplorationModel& model) override;
  void End(const ExplorationModel& model) override;

 private:
  void HandOver(std::optional<nn::Episode> episode);

  PolicyPlanner planner_;
  std::shared_ptr<OnlineLearner> learner_;
  ExperienceRecorder recorder_;
};

}  // namespace hv::explore
