#include "hv_sim/ground.h"

#include <cmath>

namespace hv::sim {
namespace {

using Eigen::Vector3d;

constexpr double kAbove_m = 0.25;
constexpr double kBelow_m = 0.15;
constexpr double kTyre_m = 0.12;
constexpr int kSamples = 5;  ///< along a tyre

/// Mean height under a tyre at `x`, `y` in the base frame.
std::optional<double> TyreHeight(const RayCaster& scene, const Pose& T_world_base, double x,
                                 double y) {
  double sum = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double along = kTyre_m * (static_cast<double>(i) / (kSamples - 1) - 0.5);
    const Vector3d contact = T_world_base * Vector3d(x + along, y, 0.0);
    const auto floor =
        FloorBelow(scene, contact + kAbove_m * Vector3d::UnitZ(), kAbove_m + kBelow_m);
    if (!floor) return std::nullopt;
    sum += *floor;
  }
  return sum / kSamples;
}

}  // namespace

std::optional<double> FloorBelow(const RayCaster& scene, const Vector3d& from, double reach_m) {
  std::vector<Hit> hits;
  scene.Cast({{from.cast<float>(), -Eigen::Vector3f::UnitZ()}}, static_cast<float>(reach_m), hits);
  if (!std::isfinite(hits.front().range)) return std::nullopt;
  return static_cast<double>(from.cast<float>().z()) - static_cast<double>(hits.front().range);
}

std::optional<Pose> OnGround(const RayCaster& scene, const WheelLayout& wheels,
                             const Pose& T_world_base) {
  const double x = 0.5 * wheels.wheel_base_m;
  const double y = 0.5 * wheels.track_m;
  const auto front_left = TyreHeight(scene, T_world_base, x, y);
  const auto front_right = TyreHeight(scene, T_world_base, x, -y);
  const auto back_left = TyreHeight(scene, T_world_base, -x, y);
  const auto back_right = TyreHeight(scene, T_world_base, -x, -y);
  if (!front_left || !front_right || !back_left || !back_right) return std::nullopt;
  const double rise_ahead = 0.5 * (*front_left + *front_right - *back_left - *back_right);
  const double rise_left = 0.5 * (*front_left + *back_left - *front_right - *back_right);
  const Vector3d ahead = T_world_base.linear().col(0);
  const Vector3d place(T_world_base.translation().x(), T_world_base.translation().y(),
                       0.25 * (*front_left + *front_right + *back_left + *back_right));
  return MakePose(RotationFromRpy(std::atan2(rise_left, wheels.track_m),
                                  -std::atan2(rise_ahead, wheels.wheel_base_m),
                                  std::atan2(ahead.y(), ahead.x())),
                  place);
}

}  // namespace hv::sim
