#pragma once

#include <map>
#include <optional>
#include <utility>

#include "hv_explore_sac/planner.h"

namespace hv::explore {

/// When driving to and fro is broken off, and how long goals that failed are left alone.
struct GuardConfig {
  bool enabled = true;
  int revisits = 2;    ///< of one viewpoint, with nothing new in between, that make a loop
  int new_cells = 20;  ///< free cells that count as something new
  double refused_radius = 10.0;  ///< viewpoints so near to a goal that failed fail too [cells]
  int refused_for = 50;          ///< decisions after which a goal that failed is tried again

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Notices that the robot comes back to viewpoints without seeing anything new, and then sends it
/// to the nearest viewpoint with utility, all the way. Since viewpoints that were visited have
/// none, every exploration ends. Not thread-safe.
class LoopGuard {
 public:
  explicit LoopGuard(const GuardConfig& config) : config_(config) {}

  /// The decision, or another one in its place.
  Decision Review(const Decision& decision, const Observation& observation,
                  const ExplorationModel& model);

  int interventions() const { return interventions_; }  ///< loops that were noticed

 private:
  bool InLoop(const Observation& observation, const ExplorationModel& model);

  GuardConfig config_;
  double explored_ = 0.0;                    ///< when something new was last seen
  std::map<std::pair<int, int>, int> seen_;  ///< how often each cell was stood at since
  std::optional<Eigen::Vector2i> goal_;      ///< while it is in charge: a cell
  int interventions_ = 0;
};

/// Goals that could not be reached, each for some time. Not thread-safe.
class RefusedGoals {
 public:
  explicit RefusedGoals(const GuardConfig& config) : config_(config) {}

  void Refuse(const Eigen::Vector2i& cell) { refused_.push_back({cell, now_}); }

  /// One decision on: forgets what has expired and takes the utility of the nodes that are refused.
  /// Returns how many nodes lost theirs.
  int Apply(Observation& observation, const ExplorationModel& model);

 private:
  struct Entry {
    Eigen::Vector2i cell;
    int since;
  };
  GuardConfig config_;
  int now_ = 0;
  std::vector<Entry> refused_;
};

}  // namespace hv::explore
