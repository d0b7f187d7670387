#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "hv_core/config.h"
#include "hv_core/imu_sample.h"
#include "hv_core/scan.h"
#include "hv_core/trajectory.h"
#include "hv_sim/lidar.h"
#include "hv_sim/motion.h"
#include "hv_sim/sensor_suite.h"
#include "hv_sim/world.h"

namespace hv::sim {

/// One message as it leaves a driver.
struct SensorMessage {
  Time arrival;       ///< when the computer gets it: IMU at once, a scan after its last firing
  Time header_stamp;  ///< what the message header says
  std::variant<ImuSample, Scan> data;
};

/// Everything that determines a recording besides the faults.
struct RecordingConfig {
  std::string world = "construction";  ///< see MakeWorld()
  std::string format = "hilti";        ///< see DefaultSuite()
  int seed = 1;                        ///< of clutter, motion and every noise
  int world_seed = -1;                 ///< of clutter; below 0: as `seed`
  MotionConfig motion;
  bool lidar_noise = true;
  bool people = true;
  double lidar_dropout = 0.0;  ///< probability that a return is lost
  double point_share = 1.0;    ///< share of columns fired
  SensorSuiteConfig suite;

  /// Seed of the clutter.
  std::uint32_t clutter_seed() const {
    return static_cast<std::uint32_t>(world_seed < 0 ? seed : world_seed);
  }
  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Moves the sensors of a suite through a world. The stream is the same for any number of threads.
/// Const methods are thread-safe.
class Recording {
 public:
  using Sink = std::function<void(SensorMessage)>;
  using Progress = std::function<void(double share)>;

  /// Throws InputError when the configuration names something unknown.
  Recording(const World& world, const RecordingConfig& config);

  /// Hands every message to `sink` in order of arrival, in the calling thread; up to
  /// `threads` threads cast rays. `progress`, if any, is told the finished share in [0, 1].
  void Stream(int threads, const Sink& sink, const Progress& progress = nullptr) const;

  /// True state of the body that carries the sensors; `seconds` from the start.
  MotionState BodyAt(double seconds) const { return motion_->At(seconds); }

  /// True pose of the IMU frame at 100 Hz and at the instants `also_at` (scan ends, for example).
  Trajectory ImuTruth(const std::vector<Time>& also_at = {}) const;

  /// True poses of the base frame, at 100 Hz.
  Trajectory BaseTruth() const;

  const RecordingConfig& config() const { return config_; }
  const SensorRig& rig() const { return rig_; }
  const LidarSimulator& lidar() const { return lidar_; }

  /// Revolutions that end within the duration.
  int scan_count() const;
  double path_length() const { return BaseTruth().PathLength(); }

 private:
  Scan MakeScan(int index) const;
  double ScanStart(int index) const;
  Time Stamp(double seconds) const;
  Trajectory Truth(const Pose& T_body_frame, const std::vector<Time>& also_at) const;

  RecordingConfig config_;
  SensorRig rig_;
  LidarSimulator lidar_;
  std::unique_ptr<Motion> motion_;
};

}  // namespace hv::sim
