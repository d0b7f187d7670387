#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hv_explore_sac/nn/sac.h"
#include "hv_explore_sac/policy/policy_network.h"
#include "hv_explore_sac/train/labels.h"

namespace hv::explore {

/// A state as learning reads it, seen in one of the kSymmetries mirrors: returns are relative to
/// their mean, which is the same for all actions and would only be noise.
nn::Transition ToTransition(const LabelledState& label, int symmetry, int pyramid_levels);

/// `count` updates of the actor on states drawn at random and randomly mirrored. Gives the mean
/// loss. Depends on the seed alone, whatever the threads.
double FitPolicy(const std::vector<LabelledState>& labels, int count, std::size_t batch,
                 int pyramid_levels, std::uint64_t seed, nn::Sac& sac);

/// `count` updates of the actor towards the mean preference (log probability) of several policies,
/// likewise. What the noise of the labels has taught one of them alone averages out.
double ImitateMean(const std::vector<std::shared_ptr<const PolicyNetwork>>& policies,
                   const std::vector<LabelledState>& labels, int count, std::size_t batch,
                   std::uint64_t seed, nn::Sac& sac);

/// How much more return the actor's choices bring on average than the goals that `utility` would
/// choose.
double MeanGain(const std::vector<LabelledState>& labels, int pyramid_levels, const nn::Sac& sac);

}  // namespace hv::explore
