#include "hv_relocalize_ndt/recent_scans.h"

#include <utility>

#include "hv_loop_btc/submap.h"

namespace hv::relocalize {

void RecentScansConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("scans", scans, "most scans that are looked for together; 1: each alone");
  visitor.Field("step_m", step_m, "way from one of them to the next [m]");
  visitor.Field("leaf_m", leaf_m, "edge of the cubes they are thinned with [m]");
}

void RecentScansConfig::Validate(ConfigProblems& problems) const {
  problems.Require(scans >= 1, "submap.scans", "must be at least 1");
  problems.Require(step_m > 0.0, "submap.step_m", "must be positive");
  problems.Require(leaf_m >= 0.01, "submap.leaf_m", "must be at least 0.01");
}

void RecentScans::Add(const std::vector<Eigen::Vector3f>& points, const Pose& T_odom_sensor) {
  if (config_.scans < 2 || points.empty()) return;
  const auto moved_m = [&] {
    return (kept_.back().T_odom_sensor.translation() - T_odom_sensor.translation()).norm();
  };
  if (!kept_.empty() && moved_m() < config_.step_m) return;
  kept_.push_back({T_odom_sensor, loop::Thinned(points, config_.leaf_m)});
  if (kept_.size() >= static_cast<std::size_t>(config_.scans)) kept_.pop_front();
}

bool RecentScans::Extends(const Pose& T_odom_sensor) const {
  return !kept_.empty() &&
         (kept_.front().T_odom_sensor.translation() - T_odom_sensor.translation()).norm() >=
             config_.step_m;
}

std::vector<Eigen::Vector3f> RecentScans::Join(const std::vector<Eigen::Vector3f>& points,
                                               const Pose& T_odom_sensor) const {
  std::vector<Eigen::Vector3f> all = points;
  for (const Kept& kept : kept_) {
    const Eigen::Isometry3f T_sensor_kept =
        (T_odom_sensor.inverse() * kept.T_odom_sensor).cast<float>();
    for (const Eigen::Vector3f& point : kept.points) all.push_back(T_sensor_kept * point);
  }
  return loop::Thinned(all, config_.leaf_m);
}

}  // namespace hv::relocalize
