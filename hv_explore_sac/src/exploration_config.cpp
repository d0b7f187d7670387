#include "hv_explore_sac/exploration_config.h"

namespace hv::explore {

void FrontierConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("block", block, "edge of the blocks in which the belief is summed up [cells]");
  visitor.Field("min_unknown", min_unknown, "fewest unknown blocks of the eight around a frontier");
  visitor.Field("max_unknown", max_unknown, "and most");
}

void FrontierConfig::Validate(ConfigProblems& problems) const {
  problems.Require(block >= 1 && block <= 100, "frontier.block", "must be 1 to 100");
  problems.Require(min_unknown >= 1, "frontier.min_unknown", "must be at least 1");
  problems.Require(max_unknown >= min_unknown && max_unknown <= 8, "frontier.max_unknown",
                   "must be min_unknown to 8");
}

void ViewpointConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("spacing_x", spacing_x, "of the lattice of viewpoints along x [cells]");
  visitor.Field("spacing_y", spacing_y, "and along y [cells]");
  visitor.Field("neighbors", neighbors, "nearest viewpoints that edges may lead to");
  visitor.Field("view_range", view_range, "from which frontier points are observable [cells]");
  visitor.Field("min_utility", min_utility, "fewer observable frontier points count as none");
  visitor.Field("new_side_deg", new_side_deg,
                "around a frontier point that the robot has been as near to, from where a look may "
                "show more; 0: from everywhere [deg]");
}

void ViewpointConfig::Validate(ConfigProblems& problems) const {
  problems.Require(spacing_x >= 1.0, "viewpoint.spacing_x", "must be at least 1");
  problems.Require(spacing_y >= 1.0, "viewpoint.spacing_y", "must be at least 1");
  problems.Require(neighbors >= 1, "viewpoint.neighbors", "must be at least 1");
  problems.Require(view_range > 0.0, "viewpoint.view_range", "must be positive");
  problems.Require(min_utility >= 1, "viewpoint.min_utility", "must be at least 1");
  problems.Require(new_side_deg >= 0.0 && new_side_deg <= 180.0, "viewpoint.new_side_deg",
                   "must be 0 to 180");
}

void SimulationConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("rays", rays, "of the simulated range sensor");
  visitor.Field("range", range, "of the simulated range sensor [cells]");
  visitor.Field("wall_depth", wall_depth, "how far into an obstacle a ray is seen [cells]");
  visitor.Field("unseen_allowed", unseen_allowed, "free cells that may stay unseen in the end");
  visitor.Field("max_steps", max_steps, "decisions after which a run is given up");
}

void SimulationConfig::Validate(ConfigProblems& problems) const {
  problems.Require(rays >= 1, "simulation.rays", "must be at least 1");
  problems.Require(range >= 1.0, "simulation.range", "must be at least 1");
  problems.Require(wall_depth >= 1, "simulation.wall_depth", "must be at least 1");
  problems.Require(unseen_allowed >= 0, "simulation.unseen_allowed", "must not be negative");
  problems.Require(max_steps >= 1, "simulation.max_steps", "must be at least 1");
}

void ExplorationConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("frontier", frontier, "which cells are frontiers");
  visitor.Section("viewpoint", viewpoint, "where viewpoints lie and what they see");
  visitor.Section("simulation", simulation, "the simulated sensor and the end of a run");
}

void ExplorationConfig::Validate(ConfigProblems& problems) const {
  frontier.Validate(problems);
  viewpoint.Validate(problems);
  simulation.Validate(problems);
}

}  // namespace hv::explore
