#include "hv_replay/bag_check.h"

#include <cmath>
#include <cstdio>
#include <cstring>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>

#include "hv_core/se3.h"
#include "hv_core/so3.h"

namespace hv::replay {
namespace {

constexpr double kStart_s = 1646310000.0;
constexpr int kScans = 90;

Eigen::Matrix3d RotationImuLidar() { return RotationFromRpy(0.3, -0.2, 1.2); }

/// A sensor that looks around in the middle of a room.
Eigen::Matrix3d RotationWorldImu(double t) {
  return RotationFromRpy(0.10 * std::sin(2.1 * t), 0.08 * std::sin(1.7 * t + 0.5),
                         0.6 * std::sin(0.9 * t) + 0.1 * std::sin(3.3 * t));
}

Eigen::Vector3d RateAt(double t) {
  constexpr double kStep = 1e-4;
  return so3::Log(RotationWorldImu(t - kStep).transpose() * RotationWorldImu(t + kStep)) /
         (2.0 * kStep);
}

/// Distance from `origin` along `direction` to the walls of a 9 x 7 x 4 m room around it.
double RangeInRoom(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d low(-4.0, -3.0, -1.5);
  const Eigen::Vector3d high(5.0, 4.0, 2.5);
  double range = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) < 1e-9) continue;
    const double wall = direction[axis] > 0.0 ? high[axis] : low[axis];
    range = std::min(range, (wall - origin[axis]) / direction[axis]);
  }
  return range;
}

struct Faults {
  double lidar_offset_s = 0.0;
  double gyro_scale = 1.0;
  double accel_scale = 1.0;
  bool imu_gap = false;
};

sensor_msgs::PointField Field(const char* name, std::uint32_t offset) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = offset;
  field.datatype = sensor_msgs::PointField::FLOAT32;
  field.count = 1;
  return field;
}

sensor_msgs::PointCloud2 CloudAt(double start, double stamp_offset) {
  constexpr int kColumns = 300;
  constexpr int kRings = 16;
  sensor_msgs::PointCloud2 cloud;
  cloud.header.stamp.fromSec(kStart_s + start + stamp_offset);
  cloud.header.frame_id = "lidar";
  cloud.fields = {Field("x", 0), Field("y", 4), Field("z", 8), Field("time", 12)};
  cloud.width = kColumns * kRings;
  cloud.height = 1;
  cloud.point_step = 16;
  cloud.row_step = cloud.width * 16;
  cloud.data.resize(cloud.row_step);
  std::uint8_t* bytes = cloud.data.data();
  for (int column = 0; column < kColumns; ++column) {
    const double time = 0.0999 * column / kColumns;
    const double azimuth = -2.0 * M_PI * column / kColumns;
    const Eigen::Matrix3d R = RotationWorldImu(start + time) * RotationImuLidar();
    for (int ring = 0; ring < kRings; ++ring, bytes += 16) {
      const double elevation = 0.5 * (ring - 7.5) / 7.5;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3d point = ray * RangeInRoom(Eigen::Vector3d::Zero(), R * ray);
      const float values[4] = {static_cast<float>(point.x()), static_cast<float>(point.y()),
                               static_cast<float>(point.z()), static_cast<float>(time)};
      std::memcpy(bytes, values, sizeof(values));
    }
  }
  return cloud;
}

sensor_msgs::Imu ImuAt(double t, const Faults& faults) {
  const Eigen::Vector3d rate = faults.gyro_scale * RateAt(t);
  const Eigen::Vector3d force =
      faults.accel_scale * (RotationWorldImu(t).transpose() * Eigen::Vector3d(0.0, 0.0, 9.81));
  sensor_msgs::Imu imu;
  imu.header.stamp.fromSec(kStart_s + t);
  imu.header.frame_id = "imu";
  imu.angular_velocity.x = rate.x();
  imu.angular_velocity.y = rate.y();
  imu.angular_velocity.z = rate.z();
  imu.linear_acceleration.x = force.x();
  imu.linear_acceleration.y = force.y();
  imu.linear_acceleration.z = force.z();
  return imu;
}

class BagCheckTest : public testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }

  BagCheck Check(const Faults& faults, const lio::SystemConfig& config) {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    for (int i = 0; i < kScans * 20 + 40; ++i) {
      const double t = 0.005 * i;
      if (faults.imu_gap && t > 3.0 && t < 3.5) continue;
      bag.write("/imu", ros::Time(kStart_s + t), ImuAt(t, faults));
    }
    for (int i = 0; i < kScans; ++i) {
      const double t = 0.05 + 0.1 * i;
      bag.write("/points", ros::Time(kStart_s + t + 0.1), CloudAt(t, -faults.lidar_offset_s));
    }
    bag.close();
    BagReader reader({path_}, {}, ImuNeed::kOptional);
    BagCheckOptions options;
    options.compare_extrinsic = true;
    return CheckBag(reader, config, options);
  }

  static lio::SystemConfig ConfigWith(const Eigen::Matrix3d& R_imu_lidar) {
    const Eigen::Quaterniond q(R_imu_lidar);
    lio::SystemConfig config;
    config.odometry.extrinsic.rotation_xyzw = {q.x(), q.y(), q.z(), q.w()};
    return config;
  }

  static std::string Report(const BagCheck& check) { return CheckReport(check, false); }

  const std::string path_ = testing::TempDir() + "/hv_" +
                            testing::UnitTest::GetInstance()->current_test_info()->name() + ".bag";
};

TEST_F(BagCheckTest, SoundBagHasNothingButGoodFindings) {
  const BagCheck check = Check({}, ConfigWith(RotationImuLidar()));
  const std::string report = Report(check);
  EXPECT_FALSE(check.HasErrors()) << report;
  for (const CheckItem& item : check.items) {
    const bool good = item.level == CheckLevel::kGood;
    EXPECT_TRUE(good) << report;
  }
  EXPECT_NEAR(check.points.rate_hz, 10.0, 0.01);
  EXPECT_NEAR(check.imu.rate_hz, 200.0, 0.1);
  EXPECT_NEAR(check.readings.acceleration_norm, 9.81, 0.01);
  ASSERT_TRUE(check.rotation.has_value());
  EXPECT_NEAR(check.rotation->offset_s, 0.0, 3e-3);
}

TEST_F(BagCheckTest, OffsetDegreesAndGAreMeasuredTogether) {
  Faults faults;
  faults.lidar_offset_s = 0.04;
  faults.gyro_scale = 57.2957795;
  faults.accel_scale = 1.0 / 9.81;
  const BagCheck check = Check(faults, ConfigWith(RotationImuLidar()));
  const std::string report = Report(check);
  ASSERT_TRUE(check.rotation.has_value()) << report;
  EXPECT_NEAR(check.rotation->offset_s, 0.04, 4e-3) << report;
  EXPECT_NE(report.find("deg/s, rad/s are needed"), std::string::npos) << report;
  EXPECT_NE(report.find("reads g, not m/s^2"), std::string::npos) << report;
  EXPECT_TRUE(check.HasErrors());
}

TEST_F(BagCheckTest, InverseExtrinsicIsRecognised) {
  const BagCheck check = Check({}, ConfigWith(RotationImuLidar().transpose()));
  const std::string report = Report(check);
  EXPECT_NE(report.find("inverse given?"), std::string::npos) << report;
  EXPECT_TRUE(check.HasErrors());
}

TEST_F(BagCheckTest, GapAndWrongExtrinsicAreReported) {
  Faults faults;
  faults.imu_gap = true;
  const BagCheck check = Check(faults, ConfigWith(RotationFromRpy(0.3, -0.2, -2.0)));
  const std::string report = Report(check);
  EXPECT_EQ(check.imu.gaps, 1U);
  EXPECT_NEAR(check.imu.longest_gap_s, 0.5, 0.01);
  EXPECT_NE(report.find("1 gaps, the longest 0.5"), std::string::npos) << report;
  EXPECT_NE(report.find("deg off"), std::string::npos) << report;
  EXPECT_NE(CheckJson(check).ToString().find("\"ok\": false"), std::string::npos);
}

TEST(StreamFigures, CountsDisorder) {
  std::vector<Time> stamps;
  for (const double t : {0.0, 0.1, 0.2, 0.15, 0.3, 0.3, 0.4, 0.9, 1.0}) {
    stamps.push_back(Time::FromSeconds(kStart_s + t));
  }
  std::vector<Time> arrivals;
  for (const Time& stamp : stamps) arrivals.push_back(stamp + 0.02);
  const StreamFigures figures = SummarizeStream(stamps, arrivals);
  EXPECT_EQ(figures.count, 9U);
  EXPECT_EQ(figures.unsorted, 1U);
  EXPECT_EQ(figures.duplicates, 1U);
  EXPECT_EQ(figures.gaps, 1U);
  EXPECT_NEAR(figures.longest_gap_s, 0.5, 1e-6);
  EXPECT_NEAR(figures.longest_gap_at_s, 0.4, 1e-6);
  EXPECT_NEAR(figures.longest_step_back_s, 0.05, 1e-6);
  EXPECT_NEAR(figures.latency_s, 0.02, 1e-6);
  EXPECT_EQ(SummarizeStream({}, {}).count, 0U);
}

TEST(ImuFigures, TellUnitsAndBadReadings) {
  std::vector<ImuSample> samples(400);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].stamp = Time::FromSeconds(kStart_s + 0.005 * static_cast<double>(i));
    samples[i].acceleration = Eigen::Vector3d(0.0, 0.0, 1.0);
    samples[i].angular_velocity = Eigen::Vector3d(0.01, 0.0, 0.0);
  }
  samples[3].acceleration.x() = std::nan("");
  samples[4].acceleration.setZero();
  samples[4].angular_velocity.setZero();
  const ImuFigures figures = SummarizeImu(samples);
  EXPECT_TRUE(figures.in_g);
  EXPECT_TRUE(figures.gravity_plausible);
  EXPECT_TRUE(figures.starts_at_rest);
  EXPECT_EQ(figures.not_finite, 1U);
  EXPECT_EQ(figures.all_zero, 1U);
  for (ImuSample& sample : samples) sample.acceleration *= 4.0;
  EXPECT_FALSE(SummarizeImu(samples).gravity_plausible);
}

}  // namespace
}  // namespace hv::replay
