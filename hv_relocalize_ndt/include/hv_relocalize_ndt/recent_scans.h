#pragma once

#include <deque>
#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_core/se3.h"

namespace hv::relocalize {

/// Submaps that are looked for when one scan is not enough.
struct RecentScansConfig {
  int scans = 10;
  double step_m = 0.5;
  double leaf_m = 0.1;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What was seen along the last metres, put together by odometry: a short drive may tell two places
/// apart that look alike from where one stands. Not thread-safe.
class RecentScans {
 public:
  explicit RecentScans(const RecentScansConfig& config) : config_(config) {}

  void Clear() { kept_.clear(); }

  /// Keeps a scan, given in the frame of its sensor, unless the sensor has hardly moved since the
  /// last one kept; the oldest makes room.
  void Add(const std::vector<Eigen::Vector3f>& points, const Pose& T_odom_sensor);

  /// Whether a scan is kept that was taken a step away from `T_odom_sensor`.
  bool Extends(const Pose& T_odom_sensor) const;

  /// `points` and all that is kept, thinned, in the frame of the sensor.
  std::vector<Eigen::Vector3f> Join(const std::vector<Eigen::Vector3f>& points,
                                    const Pose& T_odom_sensor) const;

 private:
  struct Kept {
    Pose T_odom_sensor = Pose::Identity();
    std::vector<Eigen::Vector3f> points;
  };

  RecentScansConfig config_;
  std::deque<Kept> kept_;
};

}  // namespace hv::relocalize
