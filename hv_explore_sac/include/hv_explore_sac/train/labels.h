#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hv_explore_sac/nn/replay_buffer.h"
#include "hv_explore_sac/policy/policy_config.h"
#include "hv_explore_sac/policy/policy_network.h"
#include "hv_explore_sac/train/map_supply.h"
#include "hv_explore_sac/train/rollout.h"

namespace hv::explore {

/// Where choices are measured.
struct LabelConfig {
  double share = 0.15;         ///< of the decisions of a run
  double contenders = 0.0;     ///< least preference of a goal that is tried, of the favourite's
  double wander = 0.1;         ///< share of the decisions at which any goal is driven to instead
  double elsewhere = 0.0;      ///< share of the runs that start anywhere free
  int maps = 0;                ///< of those for training, in turn and over again; 0: each once
  int crossed = 0;             ///< maps made out of two of those for training
  double length_scale = 64.0;  ///< way that costs a return of one [cells]

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// A state met, and what each of its goals brings: minus the way driven to the end of the run when
/// that goal comes first, in units of `length_scale`. Goals that were not tried have what the
/// preferences of the policy imply.
struct LabelledState {
  nn::PackedGraph state;
  Eigen::VectorXf returns;
};

/// Everything of an environment that labels are made with.
struct LabelInputs {
  ExplorationConfig exploration;
  PolicyConfig policy;
  LabelConfig labels;
  const RaySensor* sensor = nullptr;
  const Rollout* rollout = nullptr;
  const PolicyNetwork* network = nullptr;  ///< of the rollouts' policy; null: has no preferences
  double temperature = 1.0;                ///< of its preferences [returns]
};

/// Explores a map as the planner of the rollouts does, wandering off at times, and measures the
/// goals of some of the decisions on the true map: samples of what they cost on average over the
/// maps that look the same so far. Depends on the seed alone. Decisions without a choice are left
/// out, and those with a single contender.
std::vector<LabelledState> LabelMap(const ExplorationMap& map, const LabelInputs& inputs,
                                    std::uint64_t seed);

/// The same on the maps from `begin` to before `end`, in parallel and yet in their order; map i has
/// the seed `seed` + i. `report` is told the share that is done, from several threads.
std::vector<LabelledState> LabelMaps(const MapSupply& maps, std::size_t begin, std::size_t end,
                                     const LabelInputs& inputs, std::uint64_t seed,
                                     const std::function<void(double share)>& report);

/// Kept in a file with a SHA-256. Reading throws InputError, naming the file.
void WriteLabels(const std::vector<LabelledState>& labels, const std::string& path);
std::vector<LabelledState> ReadLabels(const std::string& path);

}  // namespace hv::explore
