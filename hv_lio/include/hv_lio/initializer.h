#pragma once

#include <deque>
#include <optional>
#include <string>

#include "hv_core/config.h"
#include "hv_core/imu_sample.h"
#include "hv_lio/nav_state.h"

namespace hv::lio {

struct InitializerConfig {
  double static_duration_s = 0.8;
  double static_gyro_std = 0.05;
  double static_accel_std = 0.4;
  double moving_start_after_s = 3.0;
  int moving_start_scans = 10;
  double gravity_mps2 = 9.80665;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// A state to start from and how sure it is.
struct InitialState {
  NavState state;
  ErrorMatrix covariance = ErrorMatrix::Identity();
  double accel_scale = 1.0;  ///< multiply readings by this to get m/s^2
  bool moving = false;       ///< started from a moving sensor: velocity and tilt are uncertain
};

/// Finds gravity, gyroscope bias and the accelerometer's unit from the first IMU samples (methods
/// section 1, initialisation). Standing still: the mean reading gives them. When the sensor does
/// not come to rest within `moving_start_after_s`, starts from the mean acceleration of that time,
/// each reading turned into the last frame by the gyroscope, with a covariance that says so, and
/// the filter settles the rest.
class Initializer {
 public:
  explicit Initializer(const InitializerConfig& config) : config_(config) {}

  /// Samples that are not newer than the last one are ignored.
  void Add(const ImuSample& sample);
  std::optional<InitialState> TryInitialize() const;

  /// What is being waited for, one line.
  std::string WaitingFor() const;

  /// Starts over.
  void Clear() { samples_.clear(); }

 private:
  struct Statistics;
  Statistics Summarize(double duration) const;
  Eigen::Vector3d MeanForceInLastFrame() const;
  InitialState MakeState(const Statistics& statistics, bool moving) const;

  InitializerConfig config_;
  std::deque<ImuSample> samples_;
};

}  // namespace hv::lio
