#include "hv_ros/tracked_scan_message.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

namespace hv {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

TrackedScanHeader ExampleHeader() {
  TrackedScanHeader header;
  header.stamp = Time::FromNanoseconds(1646310000819997311);
  header.odom_frame = "odom";
  header.imu_frame = "imu_link";
  header.base_frame = "base_link";
  header.segment = 3;
  header.T_odom_imu = MakePose(RotationFromRpy(0.3, -0.2, 1.1), Eigen::Vector3d(4, -2, 1));
  header.T_imu_base = MakePose(RotationFromRpy(0.0, 0.1, 0.0), Eigen::Vector3d(0, 0, -0.4));
  header.lidar_in_imu = {0.1, 0.2, 0.3};
  return header;
}

std::vector<Point> ExamplePoints() {
  std::vector<Point> points(3);
  points[1].x = 2.5F;
  points[2].intensity = 9.0F;
  return points;
}

TEST(TrackedScanMessage, KeepsEverything) {
  const TrackedScanHeader before = ExampleHeader();
  const DecodedTrackedScan after = FromMessage(*ToMessage(before, ExamplePoints()));
  ASSERT_EQ(after.error, "");
  EXPECT_EQ(after.header.stamp.nanoseconds(), before.stamp.nanoseconds());
  EXPECT_EQ(after.header.odom_frame, "odom");
  EXPECT_EQ(after.header.imu_frame, "imu_link");
  EXPECT_EQ(after.header.base_frame, "base_link");
  EXPECT_EQ(after.header.segment, 3U);
  EXPECT_TRUE(after.header.T_odom_imu.isApprox(before.T_odom_imu, 1e-12));
  EXPECT_TRUE(after.header.T_imu_base.isApprox(before.T_imu_base, 1e-12));
  EXPECT_EQ(after.header.lidar_in_imu, before.lidar_in_imu);
  ASSERT_EQ(after.points.size(), 3U);
  EXPECT_EQ(after.points[1].x, 2.5F);
  EXPECT_EQ(after.points[2].intensity, 9.0F);
}

TEST(TrackedScanMessage, WithoutPointsIsAPrediction) {
  const DecodedTrackedScan after = FromMessage(*ToMessage(ExampleHeader(), {}));
  EXPECT_EQ(after.error, "");
  EXPECT_TRUE(after.points.empty());
}

TEST(TrackedScanMessage, RowsWithoutColumnsAreNoPoints) {
  hv_msgs::TrackedScan message = *ToMessage(ExampleHeader(), ExamplePoints());
  message.cloud.width = 0;
  message.cloud.height = 0xFFFFFFFF;
  const DecodedTrackedScan after = FromMessage(message);
  EXPECT_EQ(after.error, "");
  EXPECT_TRUE(after.points.empty());
}

TEST(TrackedScanMessage, LeavesOutPointsThatAreNotFinite) {
  std::vector<Point> points = ExamplePoints();
  points[0].y = static_cast<float>(kNotANumber);
  EXPECT_EQ(FromMessage(*ToMessage(ExampleHeader(), points)).points.size(), 2U);
}

TEST(TrackedScanMessage, SaysWhatIsWrong) {
  const auto error_of = [](const std::function<void(hv_msgs::TrackedScan&)>& spoil) {
    hv_msgs::TrackedScan message = *ToMessage(ExampleHeader(), ExamplePoints());
    spoil(message);
    return FromMessage(message).error;
  };
  EXPECT_NE(error_of([](auto& scan) { scan.pose.position.x = kNotANumber; }), "");
  EXPECT_NE(error_of([](auto& scan) { scan.base_pose.orientation.w = 2.0; }), "");
  EXPECT_NE(error_of([](auto& scan) { scan.sensor_origin.z = kNotANumber; }), "");
  EXPECT_NE(error_of([](auto& scan) { scan.cloud.fields.clear(); }), "");
  EXPECT_NE(error_of([](auto& scan) { scan.cloud.data.resize(10); }), "");
  EXPECT_EQ(error_of([](auto&) {}), "");
}

}  // namespace
}  // namespace hv
