#include "hv_lio/odometry.h"

#include <chrono>
#include <cmath>
#include <utility>

#include "hv_core/so3.h"

namespace hv::lio {
namespace {

/// Wall-clock durations of consecutive stages [ms].
class StageTimer {
 public:
  double Lap() {
    const auto now = std::chrono::steady_clock::now();
    const double elapsed = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return elapsed;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Rotation about z that carries the heading of `from` to that of `to`.
Eigen::Matrix3d HeadingChange(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
  const Eigen::Matrix3d change = to * from.transpose();
  const double yaw = std::atan2(change(1, 0), change(0, 0));
  return RotationFromRpy(0.0, 0.0, yaw);
}

}  // namespace

Odometry::Odometry(const LioConfig& config)
    : config_(config),
      T_imu_lidar_(config.extrinsic.T_imu_lidar()),
      grid_(config.preprocess),
      update_(config.update),
      map_(config.map),
      arena_(config.threads) {}

void Odometry::Start(Time stamp, const InitialState& initial) {
  state_ = initial.state;
  covariance_ = initial.covariance;
  accel_scale_ = initial.accel_scale;
  if (kept_pose_) {
    state_.position = kept_pose_->translation();
    state_.rotation = HeadingChange(state_.rotation, kept_pose_->linear()) * state_.rotation;
    kept_pose_.reset();
  }
  stamp_ = stamp;
  initialized_ = true;
  settling_ = initial.moving;
  map_.Clear();
}

void Odometry::MoveClock(Time stamp) {
  constexpr double kMissedSeconds = 1.0;
  constexpr double kMissedAcceleration = 2.0;
  constexpr double kMissedTurn = 0.3;
  const double speed_change = kMissedAcceleration * kMissedSeconds;
  const double distance = (state_.velocity.norm() + 0.5 * speed_change) * kMissedSeconds;
  const auto widen = [this](int index, double sigma) {
    covariance_.diagonal().segment<3>(index).array() += sigma * sigma;
  };
  widen(ErrorIndex::kPosition, distance);
  widen(ErrorIndex::kRotation, kMissedTurn);
  widen(ErrorIndex::kVelocity, speed_change);
  stamp_ = stamp;
}

void Odometry::Reset(bool keep_pose) {
  if (keep_pose && initialized_) {
    kept_pose_ = state_.T_odom_imu();
  } else if (!keep_pose) {
    kept_pose_.reset();
  }
  map_.Clear();
  initialized_ = false;
}

std::vector<MotionKnot> Odometry::PropagateKnots(const std::vector<ImuStep>& steps,
                                                 double start_time) {
  std::vector<MotionKnot> knots;
  knots.reserve(steps.size() + 1);
  double elapsed = 0.0;
  for (const ImuStep& step : steps) {
    PropagateCovariance(step, state_, config_.imu, covariance_);
    knots.push_back(PropagateState(step, state_));
    knots.back().time = start_time + elapsed;
    elapsed += step.dt;
  }
  if (knots.empty()) {
    knots.emplace_back();
    knots.back().time = start_time;
    knots.back().position = state_.position;
    knots.back().rotation = state_.rotation;
    knots.back().velocity = state_.velocity;
  }
  return knots;
}

void Odometry::WidenDegenerate(const UpdateSummary& update, double duration) {
  constexpr int kVelocity = ErrorIndex::kVelocity;
  const double density = config_.update.degenerate_accel_noise;
  for (const Eigen::Vector3d& direction : update.degenerate_translation) {
    covariance_.block<3, 3>(kVelocity, kVelocity) +=
        density * density * duration * direction * direction.transpose();
  }
}

ScanResult Odometry::Process(const Scan& scan, const std::vector<ImuStep>& steps) {
  ScanResult result;
  StageTimer timer;
  ScanMotion motion;
  motion.knots = PropagateKnots(steps, stamp_ - scan.stamp);
  motion.end_time = scan.end() - scan.stamp;
  const double elapsed = scan.end() - stamp_;
  stamp_ = scan.end();
  arena_.Execute([&] {
    auto deskewed = std::make_shared<std::vector<Point>>(Deskew(scan, motion, T_imu_lidar_));
    const std::vector<SurfaceCell> cells = grid_.Group(*deskewed, T_imu_lidar_.translation());
    result.deskewed = std::move(deskewed);
    result.timing.preprocess_ms = timer.Lap();
    const bool first = map_.size() == 0;
    if (!first) result.update = update_.Apply(cells, map_, settling_, state_, covariance_);
    WidenDegenerate(result.update, elapsed);
    result.timing.update_ms = timer.Lap();
    const bool corrected = result.update.residuals > 0;
    if (settling_) map_.Clear();
    if (first || corrected) map_.Insert(cells, state_.T_odom_imu());
    result.timing.map_ms = timer.Lap();
    const bool tracking = corrected || (first && !cells.empty());
    result.status = tracking ? ScanStatus::kTracking : ScanStatus::kImuOnly;
  });
  if (result.status == ScanStatus::kImuOnly) {
    result.reason =
        scan.points.empty() ? "scan has no usable points" : "too few matches in the map";
  }
  result.estimate = Estimate(motion.knots.back().angular_velocity);
  result.voxels = map_.size();
  result.scan_start = scan.stamp;
  return result;
}

OdometryEstimate Odometry::Estimate(const Eigen::Vector3d& angular_velocity) const {
  using Index = ErrorIndex;
  OdometryEstimate estimate;
  estimate.stamp = stamp_;
  estimate.T_odom_imu = state_.T_odom_imu();
  estimate.velocity_odom = state_.velocity;
  estimate.angular_velocity_imu = angular_velocity;
  estimate.gyro_bias = state_.gyro_bias;
  estimate.accel_bias = state_.accel_bias;
  estimate.gravity_odom = state_.gravity;
  estimate.accel_scale = accel_scale_;

  Matrix6d to_odom_axes = Matrix6d::Identity();
  to_odom_axes.bottomRightCorner<3, 3>() = state_.rotation;
  estimate.pose_covariance =
      to_odom_axes * covariance_.topLeftCorner<6, 6>() * to_odom_axes.transpose();

  const Eigen::Matrix3d to_imu = state_.rotation.transpose();
  Eigen::Matrix<double, 3, kErrorDim> velocity_by_state =
      Eigen::Matrix<double, 3, kErrorDim>::Zero();
  velocity_by_state.block<3, 3>(0, Index::kVelocity) = to_imu;
  velocity_by_state.block<3, 3>(0, Index::kRotation) = so3::Hat(to_imu * state_.velocity);
  estimate.twist_covariance.topLeftCorner<3, 3>() =
      velocity_by_state * covariance_ * velocity_by_state.transpose();
  estimate.twist_covariance.bottomRightCorner<3, 3>() =
      covariance_.block<3, 3>(Index::kGyroBias, Index::kGyroBias) +
      config_.imu.gyro_noise * config_.imu.gyro_noise * 100.0 * Eigen::Matrix3d::Identity();
  return estimate;
}

}  // namespace hv::lio
