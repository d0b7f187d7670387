#include "hv_loop_btc/odometry_scale.h"

#include <algorithm>
#include <cmath>

namespace hv::loop {
namespace {

constexpr double kRadians = M_PI / 180.0;
/// The scale is this quantile of what single loops show, so that one false loop does not set it.
constexpr double kQuantile = 0.7;
/// Growth that is worth new weights.
constexpr double kWorthwhile = 1.3;
/// An error of heading moves the end of the way by at most about this share of its length.
constexpr double kLever = 0.7;
/// Errors of the loops themselves [m, rad].
constexpr double kLoopError_m = 0.15;
constexpr double kLoopError_rad = 0.02;

double Quantile(std::vector<double> values) {
  const auto rank = static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

}  // namespace

bool OdometryScale::Observe(const Pose& T_loop, const Pose& T_odometry, double travelled_m) {
  const double way = std::max(1.0, travelled_m);
  const double turned = RotationDistance(T_loop, T_odometry);
  const double moved = (T_loop.translation() - T_odometry.translation()).norm();
  const double turn_error = std::max(0.0, turned - kLoopError_rad);
  const double move_error = std::max(0.0, moved - kLever * turned * way - kLoopError_m);
  rotation_ratios_.push_back(turn_error / (config_.rotation_drift_deg * kRadians * std::sqrt(way)));
  translation_ratios_.push_back(move_error / (config_.translation_drift_m * std::sqrt(way)));
  const double rotation = std::max(1.0, Quantile(rotation_ratios_));
  const double translation = std::max(1.0, Quantile(translation_ratios_));
  const bool grown = rotation > kWorthwhile * rotation_ || translation > kWorthwhile * translation_;
  if (!grown) return false;
  rotation_ = std::max(rotation, rotation_);
  translation_ = std::max(translation, translation_);
  return true;
}

GraphEdge OdometryScale::Scaled(GraphEdge edge) const {
  Vector6d shrink;
  shrink.head<3>().setConstant(1.0 / translation_);
  shrink.tail<3>().setConstant(1.0 / rotation_);
  edge.information = (shrink.asDiagonal() * edge.information * shrink.asDiagonal()).eval();
  return edge;
}

}  // namespace hv::loop
