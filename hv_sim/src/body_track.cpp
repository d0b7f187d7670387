#include "body_track.h"

#include <algorithm>
#include <cmath>

#include "motion_jet.h"
#include "motion_spline.h"

namespace hv::sim {
namespace {

constexpr std::int64_t kKept = 64;

}  // namespace

void BodyTrack::Rest(const BodyControl& control) {
  ring_.assign(static_cast<std::size_t>(kKept), control);
}

void BodyTrack::Push(const BodyControl& control) {
  ++newest_;
  ring_[static_cast<std::size_t>(newest_ % kKept)] = control;
}

const BodyControl& BodyTrack::Control(std::int64_t index) const {
  const std::int64_t oldest = newest_ - kKept + 1;
  const std::int64_t first = std::max<std::int64_t>(0, oldest);
  const std::int64_t kept = std::clamp(index, first, std::max(first, newest_));
  return ring_[static_cast<std::size_t>(kept % kKept)];
}

MotionState BodyTrack::At(double time_s) const {
  const double position = time_s / kStep_s;
  const double knot = std::floor(position);
  const QuinticWeights weights(position - knot, kStep_s);
  BodyControl value = BodyControl::Zero();
  BodyControl first = BodyControl::Zero();
  BodyControl second = BodyControl::Zero();
  const std::int64_t begin = static_cast<std::int64_t>(knot) - 2;
  for (int k = 0; k < 6; ++k) {
    const BodyControl& control = Control(begin + k);
    value += weights.value[k] * control;
    first += weights.first[k] * control;
    second += weights.second[k] * control;
  }
  const auto jet = [&](int axis) { return Jet{value[axis], first[axis], second[axis]}; };
  MotionState state;
  SetTranslation(jet(0), jet(1), jet(2), state);
  SetRotation(jet(3), jet(4), jet(5), state);
  return state;
}

}  // namespace hv::sim
