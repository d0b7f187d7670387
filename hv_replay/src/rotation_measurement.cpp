#include "rotation_measurement.h"

#include <cmath>

#include <Eigen/Geometry>

#include "hv_core/angles.h"
#include "hv_core/so3.h"
#include "hv_core/trajectory.h"
#include "hv_lio/pipeline.h"

namespace hv::replay {
namespace {

constexpr int kMaxRefinements = 3;
constexpr double kSettled = 0.001;
/// Correlation of the first measurement below which refining makes no sense.
constexpr double kComparableCorrelation = 0.6;
/// The gyroscope only straightens clouds: the LiDAR shall decide about the rotation
/// [rad/s/sqrt(Hz)].
constexpr double kWeakGyroNoise = 0.05;

/// Runs what waits and keeps the poses of tracked scans, stamped `shift` seconds later.
void Drain(lio::Pipeline& pipeline, double shift, std::vector<StampedPose>& poses) {
  while (const std::optional<lio::ScanResult> result = pipeline.ProcessNext()) {
    if (result->status != lio::ScanStatus::kTracking) continue;
    poses.push_back({result->estimate.stamp + shift, result->estimate.T_odom_imu});
  }
}

/// Rotations between poses that follow each other, in the frame `R_pose_lidar` turned from theirs.
std::vector<RotationStep> StepsOf(const std::vector<StampedPose>& poses,
                                  const Eigen::Matrix3d& R_pose_lidar) {
  std::vector<RotationStep> steps;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double duration = poses[i].stamp - poses[i - 1].stamp;
    if (duration <= 0.0 || duration > 0.5) continue;
    const Eigen::Matrix3d turned = poses[i - 1].pose.linear().transpose() * poses[i].pose.linear();
    steps.push_back(
        {poses[i - 1].stamp, poses[i].stamp, R_pose_lidar.transpose() * so3::Log(turned)});
  }
  return steps;
}

/// Each cloud is taken as a rigid picture at the middle of its sweep.
std::vector<RotationStep> StepsWithoutDeskew(const std::vector<Scan>& scans,
                                             lio::LioConfig config) {
  config.use_imu = false;
  config.extrinsic = lio::ExtrinsicConfig();
  config.lidar_time_offset_s = 0.0;
  lio::Pipeline pipeline(config);
  std::vector<StampedPose> poses;
  for (const Scan& scan : scans) {
    Scan rigid = scan;
    rigid.stamp = scan.stamp + 0.5 * scan.duration;
    rigid.duration = 0.0;
    for (Point& point : rigid.points) point.time = 0.0F;
    pipeline.AddScan(std::move(rigid));
    Drain(pipeline, 0.0, poses);
  }
  return StepsOf(poses, Eigen::Matrix3d::Identity());
}

lio::ExtrinsicConfig ExtrinsicOf(const Eigen::Matrix3d& R_imu_lidar,
                                 const std::vector<double>& translation_m) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(R_imu_lidar).normalized();
  return {translation_m, {q.x(), q.y(), q.z(), q.w()}};
}

std::vector<RotationStep> StepsWithGyro(const std::vector<Scan>& scans,
                                        const std::vector<ImuSample>& samples,
                                        const RotationMatch& match, lio::LioConfig config) {
  config.use_imu = true;
  config.extrinsic = ExtrinsicOf(match.R_imu_lidar, config.extrinsic.translation_m);
  config.lidar_time_offset_s = match.offset_s;
  config.imu.gyro_noise = std::max(config.imu.gyro_noise, kWeakGyroNoise);
  const bool degrees = match.gyro_scale > 10.0;
  lio::Pipeline pipeline(config);
  std::vector<StampedPose> poses;
  std::size_t next = 0;
  for (const Scan& scan : scans) {
    pipeline.AddScan(scan);
    for (; next < samples.size() && samples[next].stamp <= scan.end() + match.offset_s; ++next) {
      ImuSample sample = samples[next];
      if (degrees) sample.angular_velocity /= kDegreesPerRadian;
      pipeline.AddImu(sample);
      Drain(pipeline, -match.offset_s, poses);
    }
  }
  return StepsOf(poses, match.R_imu_lidar);
}

}  // namespace

std::optional<RotationMatch> MeasureRotation(const std::vector<Scan>& scans,
                                             const std::vector<ImuSample>& samples,
                                             const lio::LioConfig& config) {
  std::optional<RotationMatch> match = MatchRotations(StepsWithoutDeskew(scans, config), samples);
  if (!match || match->correlation < kComparableCorrelation) return match;
  for (int i = 0; i < kMaxRefinements; ++i) {
    const std::optional<RotationMatch> refined =
        MatchRotations(StepsWithGyro(scans, samples, *match, config), samples);
    if (!refined || refined->correlation < match->correlation) break;
    const double change = std::abs(refined->offset_s - match->offset_s);
    match = refined;
    if (change < kSettled) break;
  }
  return match;
}

}  // namespace hv::replay
