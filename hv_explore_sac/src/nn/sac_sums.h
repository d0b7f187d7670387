#pragma once

#include "hv_explore_sac/nn/sac.h"

namespace hv::explore::nn {

/// One flat vector per chunk of a batch: gradient of the actor, gradient of the critics, and the
/// statistics.
struct Sac::Sums {
  enum Statistic {
    kCriticLoss,
    kActorLoss,
    kValue,
    kEntropy,
    kExcessEntropy,
    kPriorDivergence,
    kStatistics
  };

  float* actor;
  float* critic;
  float* statistics;

  void Note(Statistic statistic, float value) const { statistics[statistic] += value; }
};

}  // namespace hv::explore::nn
