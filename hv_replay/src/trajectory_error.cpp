#include "hv_replay/trajectory_error.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "hv_core/angles.h"
#include "hv_core/error.h"

namespace hv::replay {
namespace {

/// Mean time between poses [s].
double MeanInterval(const Trajectory& trajectory) {
  if (trajectory.size() < 2) return 0.0;
  const double covered = trajectory.poses().back().stamp - trajectory.poses().front().stamp;
  return covered / static_cast<double>(trajectory.size() - 1);
}

std::vector<MatchedPose> Match(const Trajectory& reference, const Trajectory& estimate,
                               double max_gap_s) {
  const bool at_reference = MeanInterval(reference) > 2.0 * MeanInterval(estimate);
  const Trajectory& sampled = at_reference ? reference : estimate;
  const Trajectory& interpolated = at_reference ? estimate : reference;
  std::vector<MatchedPose> matched;
  for (const StampedPose& sample : sampled.poses()) {
    const std::optional<Pose> other = interpolated.Interpolate(sample.stamp, max_gap_s);
    if (!other) continue;
    MatchedPose match;
    match.stamp = sample.stamp;
    match.reference = at_reference ? sample.pose : *other;
    match.estimate = at_reference ? *other : sample.pose;
    matched.push_back(match);
  }
  return matched;
}

std::string Span(const Trajectory& trajectory) {
  if (trajectory.empty()) return "no poses";
  return ToString(trajectory.poses().front().stamp) + " to " +
         ToString(trajectory.poses().back().stamp);
}

std::size_t PosesNeeded(Alignment alignment) {
  if (alignment == Alignment::kSe3) return 3;
  return alignment == Alignment::kYaw ? 2 : 1;
}

Eigen::Matrix3Xd Positions(const std::vector<MatchedPose>& matched, Pose MatchedPose::*which) {
  Eigen::Matrix3Xd positions(3, static_cast<Eigen::Index>(matched.size()));
  for (std::size_t i = 0; i < matched.size(); ++i) {
    positions.col(static_cast<Eigen::Index>(i)) = (matched[i].*which).translation();
  }
  return positions;
}

/// Least-squares rotation about z and translation from `estimate` to `reference`.
Pose AlignYaw(const Eigen::Matrix3Xd& estimate, const Eigen::Matrix3Xd& reference) {
  const Eigen::Vector3d mean_estimate = estimate.rowwise().mean();
  const Eigen::Vector3d mean_reference = reference.rowwise().mean();
  double sine = 0.0;
  double cosine = 0.0;
  for (Eigen::Index i = 0; i < estimate.cols(); ++i) {
    const Eigen::Vector3d a = estimate.col(i) - mean_estimate;
    const Eigen::Vector3d b = reference.col(i) - mean_reference;
    sine += a.x() * b.y() - a.y() * b.x();
    cosine += a.x() * b.x() + a.y() * b.y();
  }
  const Eigen::Matrix3d rotation = RotationFromRpy(0.0, 0.0, std::atan2(sine, cosine));
  return MakePose(rotation, mean_reference - rotation * mean_estimate);
}

Pose Align(const std::vector<MatchedPose>& matched, Alignment alignment) {
  if (alignment == Alignment::kNone) return Pose::Identity();
  const Eigen::Matrix3Xd reference = Positions(matched, &MatchedPose::reference);
  const Eigen::Matrix3Xd estimate = Positions(matched, &MatchedPose::estimate);
  if (alignment == Alignment::kYaw) return AlignYaw(estimate, reference);
  const Eigen::Matrix4d transform = Eigen::umeyama(estimate, reference, false);
  return MakePose(Eigen::Matrix3d(transform.topLeftCorner<3, 3>()),
                  Eigen::Vector3d(transform.topRightCorner<3, 1>()));
}

void FillAbsoluteErrors(TrajectoryError& error) {
  std::vector<double> translation, horizontal, vertical, rotation;
  Eigen::Vector3d squared = Eigen::Vector3d::Zero();
  for (MatchedPose& match : error.matched) {
    match.estimate = error.T_reference_estimate * match.estimate;
    const Eigen::Vector3d offset = match.estimate.translation() - match.reference.translation();
    match.translation_error = offset.norm();
    match.rotation_error = kDegreesPerRadian * RotationDistance(match.reference, match.estimate);
    squared += offset.cwiseAbs2();
    translation.push_back(match.translation_error);
    horizontal.push_back(offset.head<2>().norm());
    vertical.push_back(std::abs(offset.z()));
    rotation.push_back(match.rotation_error);
  }
  error.axis_rmse = (squared / static_cast<double>(error.matched.size())).cwiseSqrt();
  error.translation = Summarize(std::move(translation));
  error.horizontal = Summarize(std::move(horizontal));
  error.vertical = Summarize(std::move(vertical));
  error.rotation = Summarize(std::move(rotation));
}

/// Travelled length of the reference at each matched pose [m].
std::vector<double> ReferenceLengths(const std::vector<MatchedPose>& matched) {
  std::vector<double> lengths(matched.size(), 0.0);
  for (std::size_t i = 1; i < matched.size(); ++i) {
    const Eigen::Vector3d step =
        matched[i].reference.translation() - matched[i - 1].reference.translation();
    lengths[i] = lengths[i - 1] + step.norm();
  }
  return lengths;
}

RelativeError RelativeErrorOver(double length_m, const std::vector<MatchedPose>& matched,
                                const std::vector<double>& lengths) {
  std::vector<double> translation, rotation;
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < matched.size(); ++begin) {
    while (end < matched.size() && lengths[end] - lengths[begin] < length_m) ++end;
    if (end == matched.size()) break;
    const Pose moved_reference = matched[begin].reference.inverse() * matched[end].reference;
    const Pose moved_estimate = matched[begin].estimate.inverse() * matched[end].estimate;
    const Pose difference = moved_reference.inverse() * moved_estimate;
    translation.push_back(difference.translation().norm());
    rotation.push_back(kDegreesPerRadian * RotationDistance(difference, Pose::Identity()));
  }
  return {length_m, Summarize(std::move(translation)), Summarize(std::move(rotation))};
}

}  // namespace

Alignment ParseAlignment(const std::string& name) {
  for (const Alignment alignment : {Alignment::kSe3, Alignment::kYaw, Alignment::kNone}) {
    if (name == ToString(alignment)) return alignment;
  }
  throw InputError("alignment '" + name + "' must be se3, yaw or none");
}

std::string ToString(Alignment alignment) {
  if (alignment == Alignment::kSe3) return "se3";
  return alignment == Alignment::kYaw ? "yaw" : "none";
}

Statistics Summarize(std::vector<double> values) {
  Statistics statistics;
  statistics.count = values.size();
  if (values.empty()) return statistics;
  const double count = static_cast<double>(values.size());
  double squares = 0.0;
  for (const double value : values) {
    statistics.mean += value / count;
    squares += value * value / count;
  }
  for (const double value : values) {
    statistics.std += (value - statistics.mean) * (value - statistics.mean) / count;
  }
  statistics.rmse = std::sqrt(squares);
  statistics.std = std::sqrt(statistics.std);
  std::sort(values.begin(), values.end());
  statistics.max = values.back();
  statistics.median = 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
  return statistics;
}

TrajectoryError CompareTrajectories(const Trajectory& reference, const Trajectory& estimate,
                                    const TrajectoryErrorOptions& options) {
  TrajectoryError error;
  error.reference_poses = reference.size();
  error.estimate_poses = estimate.size();
  error.matched = Match(reference, estimate, options.max_gap_s);
  if (error.matched.size() < PosesNeeded(options.alignment)) {
    throw InputError(std::to_string(error.matched.size()) + " matched poses, alignment " +
                     ToString(options.alignment) + " needs " +
                     std::to_string(PosesNeeded(options.alignment)) + " (reference " +
                     Span(reference) + ", estimate " + Span(estimate) + ")");
  }
  error.duration_s = error.matched.back().stamp - error.matched.front().stamp;
  error.T_reference_estimate = Align(error.matched, options.alignment);
  FillAbsoluteErrors(error);
  const std::vector<double> lengths = ReferenceLengths(error.matched);
  error.path_length_m = lengths.back();
  for (const double length_m : options.rpe_lengths_m) {
    error.relative.push_back(RelativeErrorOver(length_m, error.matched, lengths));
  }
  return error;
}

}  // namespace hv::replay
