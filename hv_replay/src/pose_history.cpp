#include "pose_history.h"

#include <algorithm>
#include <iterator>

#include "hv_core/trajectory.h"

namespace hv::replay {
namespace {

constexpr double kKept_s = 1.0;
constexpr double kLate_s = 0.05;

}  // namespace

void PoseHistory::Add(const BaseMotion& motion) {
  while (!motions_.empty() && motions_.back().stamp >= motion.stamp) motions_.pop_back();
  motions_.push_back(motion);
  while (motion.stamp - motions_.front().stamp > kKept_s) motions_.pop_front();
}

std::optional<BaseMotion> PoseHistory::At(Time stamp) const {
  if (motions_.empty() || stamp < motions_.front().stamp) return std::nullopt;
  const auto after = std::find_if(motions_.begin(), motions_.end(),
                                  [stamp](const BaseMotion& m) { return m.stamp >= stamp; });
  if (after == motions_.end()) {
    if (stamp - motions_.back().stamp > kLate_s) return std::nullopt;
    return motions_.back();
  }
  if (after->stamp == stamp) return *after;
  const BaseMotion& before = *std::prev(after);
  const Trajectory between(
      {{before.stamp, before.T_odom_base}, {after->stamp, after->T_odom_base}});
  return BaseMotion{stamp, *between.Interpolate(stamp), after->velocity};
}

}  // namespace hv::replay
