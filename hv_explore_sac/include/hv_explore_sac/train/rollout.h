#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "hv_explore_sac/dungeon_environment.h"
#include "hv_explore_sac/loop_guard.h"
#include "hv_explore_sac/planner.h"

namespace hv::explore {

/// A planner for one run on a map. Called from several threads.
using PlannerMaker = std::function<std::unique_ptr<Planner>(const ExplorationMap& map)>;

/// What a decision costs when a planner takes all later ones. Const methods may run concurrently.
class Rollout {
 public:
  Rollout(PlannerMaker make_planner, const GuardConfig& guard)
      : make_planner_(std::move(make_planner)), guard_(guard) {}

  std::unique_ptr<Planner> MakePlanner(const ExplorationMap& map) const {
    return make_planner_(map);
  }

  /// Drives from where `environment` is towards the viewpoint at `goal` until that has no utility
  /// any more, then as the planner decides, to the end of the run. Gives the way driven [cells];
  /// `environment` stays as it is.
  double TravelVia(const DungeonEnvironment& environment, const Eigen::Vector2i& goal) const;

  /// To the end of the run as the planner decides.
  void Finish(DungeonEnvironment& environment) const;

 private:
  PlannerMaker make_planner_;
  GuardConfig guard_;
};

/// One edge along the shortest way to the viewpoint at `goal`. False when there is none to take:
/// the viewpoint has no utility or cannot be reached.
bool StepTowards(DungeonEnvironment& environment, const Eigen::Vector2i& goal);

}  // namespace hv::explore
