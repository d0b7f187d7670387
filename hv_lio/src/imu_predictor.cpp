#include "hv_lio/imu_predictor.h"

namespace hv::lio {
namespace {

NavState StateOf(const OdometryEstimate& estimate) {
  NavState state;
  state.position = estimate.T_odom_imu.translation();
  state.rotation = estimate.T_odom_imu.linear();
  state.velocity = estimate.velocity_odom;
  state.gyro_bias = estimate.gyro_bias;
  state.accel_bias = estimate.accel_bias;
  state.gravity = estimate.gravity_odom;
  return state;
}

}  // namespace

std::optional<OdometryEstimate> ImuPredictor::Add(const ImuSample& sample) {
  if (!sample.angular_velocity.allFinite() || !sample.acceleration.allFinite()) {
    return std::nullopt;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!samples_.empty() && sample.stamp - samples_.back().stamp < -kMaxPrediction) {
    samples_.clear();
    anchor_.reset();
  }
  if (!samples_.empty() && sample.stamp <= samples_.back().stamp) return std::nullopt;
  samples_.push_back(sample);
  while (sample.stamp - samples_.front().stamp > kMaxPrediction) samples_.pop_front();
  if (!anchor_ || sample.stamp - anchor_->stamp > kMaxPrediction) return std::nullopt;
  Step(sample);
  return Prediction();
}

void ImuPredictor::Anchor(const OdometryEstimate& estimate) {
  const std::lock_guard<std::mutex> lock(mutex_);
  anchor_ = estimate;
  state_ = StateOf(estimate);
  while (samples_.size() > 1 && samples_[1].stamp <= estimate.stamp) samples_.pop_front();
  if (samples_.empty()) {
    last_ = {};
    last_.acceleration = (state_.rotation.transpose() * -state_.gravity + state_.accel_bias) /
                         estimate.accel_scale;
    last_.angular_velocity = estimate.angular_velocity_imu + estimate.gyro_bias;
  } else {
    last_ = samples_.front();
  }
  last_.stamp = estimate.stamp;
  for (const ImuSample& sample : samples_) Step(sample);
}

void ImuPredictor::Clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  samples_.clear();
  anchor_.reset();
}

void ImuPredictor::Step(const ImuSample& sample) {
  const double dt = sample.stamp - last_.stamp;
  if (dt <= 0.0) return;
  ImuStep step;
  step.angular_velocity = 0.5 * (last_.angular_velocity + sample.angular_velocity);
  step.acceleration = 0.5 * anchor_->accel_scale * (last_.acceleration + sample.acceleration);
  step.dt = dt;
  PropagateState(step, state_);
  last_ = sample;
}

OdometryEstimate ImuPredictor::Prediction() const {
  OdometryEstimate estimate = *anchor_;
  const double dt = last_.stamp - anchor_->stamp;
  estimate.stamp = last_.stamp;
  estimate.T_odom_imu = state_.T_odom_imu();
  estimate.velocity_odom = state_.velocity;
  estimate.angular_velocity_imu = last_.angular_velocity - state_.gyro_bias;
  // First order in the short time since the scan: the velocity's and the white noise's share.
  const Eigen::Matrix3d velocity_covariance = state_.rotation *
                                              anchor_->twist_covariance.topLeftCorner<3, 3>() *
                                              state_.rotation.transpose();
  const double accel_variance = noise_.accel_noise * noise_.accel_noise * dt * dt * dt / 3.0;
  estimate.pose_covariance.topLeftCorner<3, 3>() +=
      dt * dt * 0.5 * (velocity_covariance + velocity_covariance.transpose()) +
      accel_variance * Eigen::Matrix3d::Identity();
  estimate.pose_covariance.bottomRightCorner<3, 3>() +=
      noise_.gyro_noise * noise_.gyro_noise * dt * Eigen::Matrix3d::Identity();
  return estimate;
}

}  // namespace hv::lio
