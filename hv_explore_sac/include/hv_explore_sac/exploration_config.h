#pragma once

#include <string>

#include "hv_core/config.h"

namespace hv::explore {

/// Which cells are frontiers. Lengths are in cells of the belief.
struct FrontierConfig {
  int block = 4;        ///< edge of the blocks in which the belief is summed up [cells]
  int min_unknown = 2;  ///< unknown blocks among the eight around a frontier
  int max_unknown = 7;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Where viewpoints lie and what they see. Lengths are in cells of the belief.
struct ViewpointConfig {
  double spacing_x = 639.0 / 29.0;  ///< of the lattice of samples [cells]
  double spacing_y = 479.0 / 29.0;  ///< [cells]
  int neighbors = 20;               ///< nearest viewpoints that edges may lead to
  double view_range = 70.0;         ///< from which a frontier point is observable [cells]
  int min_utility = 5;              ///< fewer observable frontier points count as none
  double new_side_deg = 0.0;        ///< see FrontierViews; 0: every view counts

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// The simulated range sensor and when a simulated place counts as explored.
struct SimulationConfig {
  int rays = 720;
  double range = 80.0;       ///< [cells]
  int wall_depth = 9;        ///< how far into an obstacle a ray is seen [cells]
  int unseen_allowed = 250;  ///< free cells that may stay unseen in the end
  int max_steps = 400;       ///< decisions after which a run is given up

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What a robot knows of the place and how its choices look; the same in training, evaluation and
/// on the robot. The defaults are the rules of the public dungeon benchmark.
struct ExplorationConfig {
  FrontierConfig frontier;
  ViewpointConfig viewpoint;
  SimulationConfig simulation;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::explore
