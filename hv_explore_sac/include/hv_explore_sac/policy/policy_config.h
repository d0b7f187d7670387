#pragma once

#include "hv_core/config.h"

namespace hv::explore {

/// What the learned policy chooses among and when it changes its mind. Lengths are in units of
/// PolicyScale: cells in the benchmark.
struct PolicyConfig {
  int most_goals = 8;        ///< among which it chooses
  double goal_decay = 0.02;  ///< of the utility with the distance, which ranks goals [1/units]
  double fresh_share = 0.3;  ///< of a goal's frontier points that no goal before it observes
  bool ways = false;         ///< the network reads the viewpoints on the ways to the goals too
  double keep_goal = 0.1;    ///< advantage of the goal that it has [log preference]

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::explore
