#include <optional>
#include <utility>

#include "hv_lio/imu_predictor.h"
#include "hv_lio/pipeline.h"
#include "hv_relocalize_ndt/localizer.h"
#include "hv_replay/robot_locator.h"
#include "pose_history.h"
#include "tracked_scan.h"

namespace hv::replay {
namespace {

/// The map and who finds a place in it.
struct MapLocalizer {
  MapLocalizer(const relocalize::LocalizerConfig& config, const std::string& path)
      : map(relocalize::PriorMap::Load(path, config.relocalize)), localizer(config, map) {}

  relocalize::PriorMap map;
  relocalize::Localizer localizer;
};

class SensorLocator : public RobotLocator {
 public:
  SensorLocator(const SlamConfig& config, const std::string& map, const sim::SensorRig& rig,
                const std::optional<Pose>& T_map_base)
      : rig_(rig), pipeline_(config.system.odometry), predictor_(config.system.odometry.imu) {
    if (map.empty()) return;
    map_.emplace(config.localization, map);
    if (T_map_base) map_->localizer.SetGuess({*T_map_base * rig_.T_base_imu});
  }

  void AddImu(const ImuSample& sample) override {
    pipeline_.AddImu(sample);
    if (map_) Take(map_->localizer.Wait(sample.stamp));
    if (const auto estimate = predictor_.Add(sample)) history_.Add(MotionOf(*estimate));
  }
  void AddTruth(const sim::TrueState&) override {}
  void AddScan(Scan scan) override { pipeline_.AddScan(std::move(scan)); }

  std::optional<LocatedScan> NextScan() override;
  std::optional<RobotPlace> At(Time stamp) const override;

 private:
  BaseMotion MotionOf(const lio::OdometryEstimate& estimate) const;
  void Take(const relocalize::LocalizerUpdate& update);

  sim::SensorRig rig_;
  lio::Pipeline pipeline_;
  lio::ImuPredictor predictor_;
  std::optional<MapLocalizer> map_;
  PoseHistory history_;
  Pose T_map_odom_ = Pose::Identity();
  bool localized_ = false;
  std::uint32_t segment_ = 0;
};

BaseMotion SensorLocator::MotionOf(const lio::OdometryEstimate& estimate) const {
  BaseMotion motion;
  motion.stamp = estimate.stamp;
  motion.T_odom_base = estimate.T_odom_imu * rig_.T_base_imu.inverse();
  const Eigen::Vector3d turn = rig_.T_base_imu.linear() * estimate.angular_velocity_imu;
  const Eigen::Vector3d of_imu = motion.T_odom_base.linear().transpose() * estimate.velocity_odom;
  motion.velocity.linear_mps = (of_imu - turn.cross(rig_.T_base_imu.translation())).x();
  motion.velocity.angular_rps = turn.z();
  return motion;
}

std::optional<LocatedScan> SensorLocator::NextScan() {
  while (std::optional<lio::ScanResult> result = pipeline_.ProcessNext()) {
    if (result->segment != segment_) {
      predictor_.Clear();
      history_.Clear();
      segment_ = result->segment;
    }
    if (result->status != lio::ScanStatus::kTracking || !result->deskewed) continue;
    predictor_.Anchor(result->estimate);
    if (map_) {
      const Eigen::Vector3d lidar_in_imu = rig_.T_imu_lidar().translation();
      Take(map_->localizer.Add(TrackedScanOf(*result, lidar_in_imu)));
    }
    localized_ |= !map_;
    LocatedScan scan;
    scan.stamp = result->estimate.stamp;
    scan.T_odom_base = result->estimate.T_odom_imu * rig_.T_base_imu.inverse();
    scan.segment = segment_;
    const Eigen::Isometry3f T_lidar_imu = rig_.T_imu_lidar().inverse().cast<float>();
    scan.points = *result->deskewed;
    for (Point& point : scan.points) {
      const Eigen::Vector3f at = T_lidar_imu * Eigen::Vector3f(point.x, point.y, point.z);
      point.x = at.x();
      point.y = at.y();
      point.z = at.z();
    }
    return scan;
  }
  return std::nullopt;
}

void SensorLocator::Take(const relocalize::LocalizerUpdate& update) {
  localized_ = update.state != relocalize::LocalizerState::kLost;
  if (localized_) T_map_odom_ = update.T_map_odom;
}

std::optional<RobotPlace> SensorLocator::At(Time stamp) const {
  const std::optional<BaseMotion> motion = history_.At(stamp);
  if (!motion) return std::nullopt;
  return RobotPlace{motion->stamp, motion->T_odom_base, T_map_odom_, localized_, motion->velocity};
}

}  // namespace

std::unique_ptr<RobotLocator> LocateBySensors(const SlamConfig& config, const std::string& map,
                                              const sim::SensorRig& rig,
                                              const std::optional<Pose>& T_map_base) {
  return std::make_unique<SensorLocator>(config, map, rig, T_map_base);
}

}  // namespace hv::replay
