#include "hv_replay/rotation_match.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace hv::replay {
namespace {

constexpr std::size_t kMinSteps = 50;
/// Slower than this on average, noise hides the rotation [rad/s].
constexpr double kMinRate = 0.02;
constexpr double kCoarseStep = 0.01;
constexpr double kFineStep = 0.001;
/// Times that outliers are left out and the rest is fitted again.
constexpr int kTrimmings = 4;
/// Share of the second singular value above which two axes were excited.
constexpr double kSecondAxisShare = 0.03;

/// Integral of the angular velocity over time, to be read at any instant.
class GyroIntegral {
 public:
  explicit GyroIntegral(const std::vector<ImuSample>& samples) {
    for (const ImuSample& sample : samples) {
      if (!sample.angular_velocity.allFinite()) continue;
      if (!stamps_.empty() && sample.stamp <= stamps_.back()) continue;
      if (!stamps_.empty()) {
        const double dt = sample.stamp - stamps_.back();
        const Eigen::Vector3d mean = 0.5 * (last_rate_ + sample.angular_velocity);
        integrals_.push_back(integrals_.back() + mean * dt);
      } else {
        integrals_.emplace_back(Eigen::Vector3d::Zero());
      }
      stamps_.push_back(sample.stamp);
      last_rate_ = sample.angular_velocity;
    }
  }

  std::optional<Eigen::Vector3d> At(Time stamp) const {
    const auto after = std::upper_bound(stamps_.begin(), stamps_.end(), stamp);
    if (after == stamps_.begin() || after == stamps_.end()) return std::nullopt;
    const std::size_t i = static_cast<std::size_t>(after - stamps_.begin());
    const double ratio = (stamp - stamps_[i - 1]) / (stamps_[i] - stamps_[i - 1]);
    return Eigen::Vector3d((1.0 - ratio) * integrals_[i - 1] + ratio * integrals_[i]);
  }

 private:
  std::vector<Time> stamps_;
  std::vector<Eigen::Vector3d> integrals_;
  Eigen::Vector3d last_rate_ = Eigen::Vector3d::Zero();
};

/// Pairs of rotations over the same interval.
struct Pairs {
  std::vector<Eigen::Vector3d> gyro, lidar;
};

Pairs PairUp(const std::vector<RotationStep>& lidar, const GyroIntegral& gyro, double offset_s) {
  Pairs pairs;
  for (const RotationStep& step : lidar) {
    const std::optional<Eigen::Vector3d> begin = gyro.At(step.begin + offset_s);
    const std::optional<Eigen::Vector3d> end = gyro.At(step.end + offset_s);
    if (!begin || !end) continue;
    pairs.gyro.emplace_back(*end - *begin);
    pairs.lidar.push_back(step.rotation);
  }
  return pairs;
}

Eigen::Vector3d Mean(const std::vector<Eigen::Vector3d>& vectors) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vector : vectors) sum += vector;
  return sum / static_cast<double>(std::max<std::size_t>(vectors.size(), 1));
}

/// Best rotation between centred pairs (Kabsch) and how well it fits.
RotationMatch Fit(const Pairs& pairs, double offset_s) {
  RotationMatch match;
  match.offset_s = offset_s;
  match.steps = pairs.gyro.size();
  const Eigen::Vector3d mean_gyro = Mean(pairs.gyro);
  const Eigen::Vector3d mean_lidar = Mean(pairs.lidar);
  double gyro_squares = 0.0;
  double lidar_squares = 0.0;
  for (std::size_t i = 0; i < pairs.gyro.size(); ++i) {
    const Eigen::Vector3d a = pairs.gyro[i] - mean_gyro;
    const Eigen::Vector3d b = pairs.lidar[i] - mean_lidar;
    match.covariance += a * b.transpose();
    gyro_squares += a.squaredNorm();
    lidar_squares += b.squaredNorm();
  }
  match.norms = std::sqrt(gyro_squares * lidar_squares);
  if (!(match.norms > 0.0)) return match;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(match.covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d u = svd.matrixU();
  const Eigen::Matrix3d v = svd.matrixV();
  const Eigen::Vector3d signs(1.0, 1.0, (u * v.transpose()).determinant() < 0.0 ? -1.0 : 1.0);
  match.R_imu_lidar = u * signs.asDiagonal() * v.transpose();
  const Eigen::Vector3d singular = svd.singularValues();
  match.all_axes = singular[1] > kSecondAxisShare * singular[0];
  match.correlation = singular.dot(signs) / match.norms;
  match.gyro_scale = singular.dot(signs) / lidar_squares;
  return match;
}

double MedianNorm(const std::vector<Eigen::Vector3d>& vectors) {
  std::vector<double> norms;
  for (const Eigen::Vector3d& vector : vectors) norms.push_back(vector.norm());
  std::sort(norms.begin(), norms.end());
  return norms.empty() ? 0.0 : norms[norms.size() / 2];
}

/// Leaves out steps that disagree by far, such as those of a registration that slipped. The scale
/// comes from medians, as slips spoil the one of the fit.
std::vector<RotationStep> WithoutOutliers(const std::vector<RotationStep>& lidar,
                                          const GyroIntegral& gyro, const RotationMatch& match) {
  const Pairs all = PairUp(lidar, gyro, match.offset_s);
  const double scale = MedianNorm(all.gyro) / std::max(MedianNorm(all.lidar), 1e-9);
  std::vector<Eigen::Vector3d> residuals;
  std::vector<RotationStep> paired;
  for (const RotationStep& step : lidar) {
    const Pairs pair = PairUp({step}, gyro, match.offset_s);
    if (pair.gyro.empty()) continue;
    residuals.emplace_back(pair.gyro[0] - scale * (match.R_imu_lidar * pair.lidar[0]));
    paired.push_back(step);
  }
  const double limit = 5.0 * MedianNorm(residuals);
  std::vector<RotationStep> kept;
  for (std::size_t i = 0; i < paired.size(); ++i) {
    if (residuals[i].norm() <= limit) kept.push_back(paired[i]);
  }
  return kept;
}

/// Best fit with offsets from `low` to `high`.
RotationMatch Search(const std::vector<RotationStep>& lidar, const GyroIntegral& gyro, double low,
                     double high, double step) {
  RotationMatch best;
  const int count = static_cast<int>(std::lround((high - low) / step));
  for (int i = 0; i <= count; ++i) {
    const double offset = low + i * step;
    const Pairs pairs = PairUp(lidar, gyro, offset);
    if (pairs.gyro.size() < kMinSteps) continue;
    const RotationMatch match = Fit(pairs, offset);
    if (match.correlation > best.correlation) best = match;
  }
  return best;
}

double RmsRate(const std::vector<RotationStep>& lidar) {
  double squares = 0.0;
  for (const RotationStep& step : lidar) {
    const double duration = std::max(step.end - step.begin, 1e-3);
    squares += (step.rotation / duration).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(lidar.size(), 1)));
}

}  // namespace

double RotationMatch::CorrelationWith(const Eigen::Matrix3d& rotation) const {
  return norms > 0.0 ? (rotation.transpose() * covariance).trace() / norms : 0.0;
}

std::optional<RotationMatch> MatchRotations(const std::vector<RotationStep>& lidar,
                                            const std::vector<ImuSample>& gyro,
                                            double max_offset_s) {
  if (lidar.size() < kMinSteps || RmsRate(lidar) < kMinRate) return std::nullopt;
  const GyroIntegral integral(gyro);
  RotationMatch match = Search(lidar, integral, -max_offset_s, max_offset_s, kCoarseStep);
  if (match.steps < kMinSteps) return std::nullopt;
  for (int i = 0; i < kTrimmings; ++i) {
    const std::vector<RotationStep> consistent = WithoutOutliers(lidar, integral, match);
    const RotationMatch refined = Search(consistent, integral, match.offset_s - 2.0 * kCoarseStep,
                                         match.offset_s + 2.0 * kCoarseStep, kFineStep);
    if (refined.steps < kMinSteps) break;
    match = refined;
  }
  match.rms_rate = RmsRate(lidar);
  return match;
}

}  // namespace hv::replay
