#include "hv_loop_btc/odometry_model.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "hv_core/angles.h"
#include "hv_core/so3.h"

namespace hv::loop {
namespace {

/// Loops before anything is said about systematic drift, their disagreement with odometry [sigmas],
/// and the share of it that the drift has to explain.
constexpr std::size_t kFewestLoops = 6;
constexpr double kDisagreement = 4.0;
constexpr double kExplains = 0.3;
constexpr int kIterations = 8;
/// What is believed of the drift without loops.
constexpr double kPriorStretch = 0.02;
constexpr double kPriorHeading = 0.5 * kRadiansPerDegree;
/// Changes that are worth new edges: the same over a hundred metres moves keyframes visibly.
constexpr double kNewStretch = 2e-4;
constexpr double kNewHeading = 0.002 * kRadiansPerDegree;
constexpr double kNewScale = 1.3;
/// The noise is this quantile of what single loops show, so that one false loop does not set it.
constexpr double kQuantile = 0.7;
/// Loops cannot show that odometry is better than this share of what is assumed.
constexpr double kLeastScale = 0.05;
/// Bounds of the error of odometry that is expected: loops that differ less are the same, and
/// beyond the most, other places may look alike [m].
constexpr double kLeastExpected_m = 0.15;
constexpr double kMostExpected_m = 0.5;
/// Errors of the loops themselves [m, rad].
constexpr double kLoopError_m = 0.02;
constexpr double kLoopError_rad = 0.003;
/// An error of heading moves the end of the way by about this share of its length.
constexpr double kLever = 0.7;

double Quantile(std::vector<double> values) {
  const auto rank = static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

/// What is left of `observed` when independent errors of size `known` are taken out.
double Excess(double observed, double known) {
  return std::sqrt(std::max(0.0, observed * observed - known * known));
}

}  // namespace

Pose SystematicDrift::Correct(const Pose& step, const Eigen::Vector3d& up_from) const {
  const double length = step.translation().norm();
  const Eigen::Vector3d turn = heading_rad_per_m * length * up_from;
  Pose corrected = step;
  corrected.linear() = so3::Exp(turn) * step.linear();
  corrected.translation() = (1.0 + stretch) * step.translation();
  return corrected;
}

void OdometryModel::AddKeyframe(const Keyframe& keyframe) {
  Node node{keyframe.T_odom_imu, UpInImu(keyframe), 0.0, keyframe.segment};
  if (!nodes_.empty()) {
    const Node& last = nodes_.back();
    const Pose step = last.T_odom_imu.inverse() * node.T_odom_imu;
    node.travelled_m = last.travelled_m + step.translation().norm();
  }
  index_[keyframe.id] = nodes_.size();
  nodes_.push_back(node);
}

void OdometryModel::AddLoop(std::uint32_t from, std::uint32_t to, const Pose& T_from_to) {
  if (index_.count(from) == 0 || index_.count(to) == 0) return;
  const Loop loop{index_.at(from), index_.at(to), T_from_to};
  if (nodes_[loop.from].segment == nodes_[loop.to].segment) loops_.push_back(loop);
}

double OdometryModel::Way(const Loop& loop) const {
  return std::max(1.0, std::abs(nodes_[loop.to].travelled_m - nodes_[loop.from].travelled_m));
}

std::vector<Pose> OdometryModel::Chain(const SystematicDrift& drift) const {
  std::vector<Pose> chain;
  chain.reserve(nodes_.size());
  chain.push_back(nodes_.front().T_odom_imu);
  for (std::size_t i = 1; i < nodes_.size(); ++i) {
    const Pose step = nodes_[i - 1].T_odom_imu.inverse() * nodes_[i].T_odom_imu;
    chain.push_back(chain.back() * drift.Correct(step, nodes_[i - 1].up_imu));
  }
  return chain;
}

std::vector<Vector6d> OdometryModel::Residuals(const SystematicDrift& drift) const {
  const std::vector<Pose> chain = Chain(drift);
  std::vector<Vector6d> residuals;
  residuals.reserve(loops_.size());
  for (const Loop& loop : loops_) {
    const Pose T_odometry = chain[loop.from].inverse() * chain[loop.to];
    const double way = Way(loop);
    const double turn_sigma =
        std::hypot(kLoopError_rad, config_.rotation_drift_deg * kRadiansPerDegree * std::sqrt(way));
    const double move_sigma =
        std::hypot(kLoopError_m, config_.translation_drift_m * std::sqrt(way)) +
        kLever * way * config_.rotation_drift_deg * kRadiansPerDegree * std::sqrt(way);
    Vector6d residual = se3::Log(loop.T_from_to.inverse() * T_odometry);
    residual.head<3>() /= move_sigma;
    residual.tail<3>() /= turn_sigma;
    residuals.push_back(residual);
  }
  return residuals;
}

OdometryModel::Fit OdometryModel::Linearize(const SystematicDrift& drift) const {
  constexpr double kStep = 1e-6;
  const std::vector<Vector6d> at = Residuals(drift);
  const std::vector<Vector6d> stretched =
      Residuals({drift.stretch + kStep, drift.heading_rad_per_m});
  const std::vector<Vector6d> turned = Residuals({drift.stretch, drift.heading_rad_per_m + kStep});
  std::vector<double> norms;
  for (const Vector6d& residual : at) norms.push_back(residual.norm());
  const double scale = std::max(3.0, Quantile(norms));
  Fit fit;
  for (std::size_t i = 0; i < at.size(); ++i) {
    Eigen::Matrix<double, 6, 2> jacobian;
    jacobian.col(0) = (stretched[i] - at[i]) / kStep;
    jacobian.col(1) = (turned[i] - at[i]) / kStep;
    const double weight = 1.0 / (1.0 + at[i].squaredNorm() / (scale * scale));
    fit.information += weight * jacobian.transpose() * jacobian;
    fit.gradient += weight * jacobian.transpose() * at[i];
  }
  fit.cost = Quantile(norms);
  return fit;
}

SystematicDrift OdometryModel::FitDrift() const {
  SystematicDrift drift = drift_;
  Fit fit = Linearize(drift);
  const double before = drift_.stretch == 0.0 && drift_.heading_rad_per_m == 0.0
                            ? fit.cost
                            : Linearize(SystematicDrift()).cost;
  const Eigen::Vector2d prior(1.0 / (kPriorStretch * kPriorStretch),
                              1.0 / (kPriorHeading * kPriorHeading));
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::Matrix2d information = fit.information + prior.asDiagonal().toDenseMatrix();
    const Eigen::Vector2d gradient =
        fit.gradient + prior.cwiseProduct(Eigen::Vector2d(drift.stretch, drift.heading_rad_per_m));
    const Eigen::Vector2d step = -information.ldlt().solve(gradient);
    drift.stretch += step[0];
    drift.heading_rad_per_m += step[1];
    fit = Linearize(drift);
  }
  const bool shown = before > kDisagreement && fit.cost < (1.0 - kExplains) * before;
  return shown ? drift : SystematicDrift();
}

bool OdometryModel::MeasureNoise() {
  const std::vector<Pose> chain = Chain(drift_);
  std::vector<double> translation;
  std::vector<double> rotation;
  for (const Loop& loop : loops_) {
    const Pose T_odometry = chain[loop.from].inverse() * chain[loop.to];
    const double way = Way(loop);
    const double turned = RotationDistance(loop.T_from_to, T_odometry);
    const double moved = (loop.T_from_to.translation() - T_odometry.translation()).norm();
    const double straight = std::max(0.0, moved - kLever * turned * way);
    rotation.push_back(Excess(turned, kLoopError_rad) /
                       (config_.rotation_drift_deg * kRadiansPerDegree * std::sqrt(way)));
    translation.push_back(Excess(straight, kLoopError_m) /
                          (config_.translation_drift_m * std::sqrt(way)));
  }
  // Few loops can agree with odometry by chance.
  const double least = std::max(kLeastScale, 1.0 / static_cast<double>(loops_.size()));
  const double new_translation = std::max(least, Quantile(translation));
  const double new_rotation = std::max(least, Quantile(rotation));
  const auto differs = [](double a, double b) { return a > kNewScale * b || b > kNewScale * a; };
  if (!differs(new_translation, translation_scale_) && !differs(new_rotation, rotation_scale_)) {
    return false;
  }
  translation_scale_ = new_translation;
  rotation_scale_ = new_rotation;
  return true;
}

bool OdometryModel::Learn() {
  if (loops_.empty()) return false;
  bool drift_changed = false;
  if (loops_.size() >= kFewestLoops) {
    const SystematicDrift drift = FitDrift();
    drift_changed = std::abs(drift.stretch - drift_.stretch) > kNewStretch ||
                    std::abs(drift.heading_rad_per_m - drift_.heading_rad_per_m) > kNewHeading;
    if (drift_changed) drift_ = drift;
  }
  const bool noise_changed = MeasureNoise();
  return drift_changed || noise_changed;
}

double OdometryModel::ExpectedError(double way_m) const {
  if (loops_.size() < kFewestLoops) return 0.0;
  const double root = std::sqrt(way_m);
  const double turn = rotation_scale_ * config_.rotation_drift_deg * kRadiansPerDegree * root;
  const double move = translation_scale_ * config_.translation_drift_m * root;
  const double expected = kLeastExpected_m + 3.0 * (move + kLever * way_m * turn);
  return expected < kMostExpected_m ? expected : 0.0;
}

GraphEdge OdometryModel::Corrected(GraphEdge edge) const {
  if (index_.count(edge.from) == 0) return edge;
  edge.T_from_to = drift_.Correct(edge.T_from_to, nodes_[index_.at(edge.from)].up_imu);
  Vector6d shrink;
  shrink.head<3>().setConstant(1.0 / translation_scale_);
  shrink.tail<3>().setConstant(1.0 / rotation_scale_);
  edge.information = (shrink.asDiagonal() * edge.information * shrink.asDiagonal()).eval();
  return edge;
}

}  // namespace hv::loop
