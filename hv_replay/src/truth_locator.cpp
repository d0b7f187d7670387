#include <deque>
#include <optional>
#include <utility>

#include "hv_replay/robot_locator.h"
#include "pose_history.h"

namespace hv::replay {
namespace {

class TruthLocator : public RobotLocator {
 public:
  TruthLocator(const Pose& T_map_world, const sim::SensorRig& rig)
      : T_map_world_(T_map_world), T_base_lidar_(rig.T_base_lidar) {}

  void AddImu(const ImuSample&) override {}
  void AddTruth(const sim::TrueState& state) override {
    const sim::MotionState& base = state.base;
    const Eigen::Vector3d velocity = base.T_world_body.linear().transpose() * base.velocity;
    history_.Add({state.stamp, base.T_world_body, {velocity.x(), base.angular_velocity.z()}});
  }
  void AddScan(Scan scan) override { scans_.push_back(std::move(scan)); }

  std::optional<LocatedScan> NextScan() override;
  std::optional<RobotPlace> At(Time stamp) const override;

 private:
  LocatedScan Undistorted(const Scan& scan, const BaseMotion& end) const;

  Pose T_map_world_;
  Pose T_base_lidar_;
  PoseHistory history_;
  std::deque<Scan> scans_;
};

std::optional<LocatedScan> TruthLocator::NextScan() {
  while (!scans_.empty()) {
    const Scan scan = std::move(scans_.front());
    scans_.pop_front();
    if (const auto end = history_.At(scan.end())) return Undistorted(scan, *end);
  }
  return std::nullopt;
}

LocatedScan TruthLocator::Undistorted(const Scan& scan, const BaseMotion& end) const {
  LocatedScan located{end.stamp, {}, end.T_odom_base, 0};
  located.points.reserve(scan.points.size());
  const Pose T_lidar_world = (end.T_odom_base * T_base_lidar_).inverse();
  Eigen::Isometry3f T_end_then = Eigen::Isometry3f::Identity();
  std::int64_t millisecond = -1;
  for (const Point& point : scan.points) {
    const auto now = static_cast<std::int64_t>(1e3F * point.time);
    if (now != millisecond) {
      const auto then = history_.At(scan.stamp + static_cast<double>(point.time));
      if (!then) continue;
      T_end_then = (T_lidar_world * then->T_odom_base * T_base_lidar_).cast<float>();
      millisecond = now;
    }
    const Eigen::Vector3f at = T_end_then * Eigen::Vector3f(point.x, point.y, point.z);
    Point moved = point;
    moved.x = at.x();
    moved.y = at.y();
    moved.z = at.z();
    located.points.push_back(moved);
  }
  return located;
}

std::optional<RobotPlace> TruthLocator::At(Time stamp) const {
  const std::optional<BaseMotion> motion = history_.At(stamp);
  if (!motion) return std::nullopt;
  return RobotPlace{motion->stamp, motion->T_odom_base, T_map_world_, true, motion->velocity};
}

}  // namespace

std::unique_ptr<RobotLocator> LocateByTruth(const Pose& T_map_world, const sim::SensorRig& rig) {
  return std::make_unique<TruthLocator>(T_map_world, rig);
}

}  // namespace hv::replay
