#include "hv_sim/sensor_suite.h"

#include <cmath>

#include "hv_core/angles.h"
#include "hv_core/error.h"

namespace hv::sim {
namespace {

/// Frame of the Alphasense IMU, upside down under the LiDAR; BMI085 noise.
SensorSuiteConfig Hilti() {
  SensorSuiteConfig suite;
  suite.T_base_lidar = {-0.001, -0.00855, 0.055, 0.7071068, -0.7071068, 0.0, 0.0};
  suite.base_rpy_deg = {180.0, 0.0, -90.0};
  return suite;
}

/// Segway of the University of Michigan: body with z down, HDL-32E hanging upside down above it,
/// MicroStrain 3DM-GX3 (noise of its data sheet).
SensorSuiteConfig Nclt() {
  SensorSuiteConfig suite;
  suite.lidar = "hdl_32e";
  suite.epoch_s = 1326207600.0;
  const Eigen::Quaterniond q(RotationFromRpy(0.807 * kRadiansPerDegree, 0.166 * kRadiansPerDegree,
                                             -90.703 * kRadiansPerDegree));
  suite.T_base_lidar = {0.002, -0.004, -0.957, q.x(), q.y(), q.z(), q.w()};
  suite.T_base_imu = {-0.11, -0.18, -0.71, 0.0, 0.0, 0.0, 1.0};
  suite.base_rpy_deg = {180.0, 0.0, 0.0};
  suite.imu.rate_hz = 100.0;
  suite.imu.gyro_noise = 5.2e-4;
  suite.imu.accel_noise = 7.8e-4;
  return suite;
}

/// Ground robot with base_link on the floor, PandarXT-32 (its y axis forward) and LPMS-IG1.
SensorSuiteConfig Robot() {
  SensorSuiteConfig suite;
  suite.epoch_s = 1700000000.0;
  suite.T_base_lidar = {0.12, 0.0, 0.60, 0.0, 0.0, -std::sqrt(0.5), std::sqrt(0.5)};
  suite.T_base_imu = {-0.06, 0.02, 0.21, 0.0, 0.0, 0.0, 1.0};
  suite.imu.rate_hz = 200.0;
  suite.imu.gyro_noise = 7e-5;
  suite.imu.accel_noise = 8e-4;
  suite.imu.gyro_bias_sigma = 1e-3;
  suite.imu.accel_bias_sigma = 2e-2;
  return suite;
}

Pose ToPose(const std::vector<double>& v) {
  return MakePose(Eigen::Quaterniond(v[6], v[3], v[4], v[5]).normalized(),
                  Eigen::Vector3d(v[0], v[1], v[2]));
}

bool IsPose(const std::vector<double>& v) {
  return v.size() == 7 && std::abs(Eigen::Vector4d(v[3], v[4], v[5], v[6]).norm() - 1.0) < 1e-3;
}

}  // namespace

void SensorSuiteConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("lidar", lidar, "pandar_xt32 or hdl_32e");
  visitor.Field("epoch_s", epoch_s, "sensor clock at the start [s]");
  visitor.Field("first_scan_s", first_scan_s, "start of the first revolution [s]");
  visitor.Field("T_base_imu", T_base_imu, "pose of the IMU in the base frame: x y z qx qy qz qw");
  visitor.Field("T_base_lidar", T_base_lidar,
                "pose of the LiDAR in the base frame: x y z qx qy qz qw");
  visitor.Field("base_rpy_deg", base_rpy_deg,
                "attitude of the base frame against x forward, z up: roll pitch yaw [deg]");
  visitor.Section("imu", imu, "errors of the IMU");
}

void SensorSuiteConfig::Validate(ConfigProblems& problems) const {
  problems.Require(lidar == "pandar_xt32" || lidar == "hdl_32e", "lidar",
                   "unknown LiDAR '" + lidar + "'");
  problems.Require(epoch_s >= 0.0 && epoch_s < 4e9, "epoch_s", "must be in [0, 4e9)");
  problems.Require(first_scan_s >= 0.0, "first_scan_s", "must not be negative");
  problems.Require(IsPose(T_base_imu), "T_base_imu", "needs x y z and a unit quaternion");
  problems.Require(IsPose(T_base_lidar), "T_base_lidar", "needs x y z and a unit quaternion");
  problems.Require(base_rpy_deg.size() == 3, "base_rpy_deg", "needs three angles");
  imu.Validate(problems);
}

std::vector<std::string> FormatNames() { return {"hilti", "nclt", "robot"}; }

SensorSuiteConfig DefaultSuite(const std::string& format) {
  if (format == "hilti") return Hilti();
  if (format == "nclt") return Nclt();
  if (format == "robot") return Robot();
  throw InputError("format '" + format + "' is unknown; known are hilti, nclt, robot");
}

SensorRig MakeRig(const SensorSuiteConfig& suite) {
  SensorRig rig;
  rig.T_base_imu = ToPose(suite.T_base_imu);
  rig.T_base_lidar = ToPose(suite.T_base_lidar);
  const std::vector<double>& rpy = suite.base_rpy_deg;
  const Eigen::Matrix3d R_body_base = RotationFromRpy(
      rpy[0] * kRadiansPerDegree, rpy[1] * kRadiansPerDegree, rpy[2] * kRadiansPerDegree);
  const Eigen::Vector3d t_body_base = -(R_body_base * rig.T_base_lidar.translation());
  rig.T_body_base = MakePose(R_body_base, t_body_base);
  return rig;
}

LidarModel MakeLidarModel(const SensorSuiteConfig& suite) {
  if (suite.lidar == "pandar_xt32") return PandarXt32();
  if (suite.lidar == "hdl_32e") return Hdl32e();
  throw InputError("LiDAR '" + suite.lidar + "' is unknown; known are pandar_xt32, hdl_32e");
}

}  // namespace hv::sim
