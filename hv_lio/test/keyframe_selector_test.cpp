#include "hv_lio/keyframe_selector.h"

#include <gtest/gtest.h>

namespace hv::lio {
namespace {

ScanResult TrackedAt(double x, double yaw, std::uint32_t segment = 0) {
  ScanResult result;
  result.status = ScanStatus::kTracking;
  result.segment = segment;
  result.estimate.T_odom_imu = MakePose(RotationFromRpy(0.0, 0.0, yaw), {x, 0.0, 0.0});
  result.deskewed = std::make_shared<std::vector<Point>>(5);
  return result;
}

TEST(KeyframeSelectorTest, DistanceOrTurnMakesAKeyframe) {
  KeyframeSelector selector(0.5, 20.0);
  EXPECT_EQ(selector.Add(TrackedAt(0.0, 0.0)).value().id, 0U);
  EXPECT_FALSE(selector.Add(TrackedAt(0.49, 0.1)).has_value());
  EXPECT_EQ(selector.Add(TrackedAt(0.51, 0.0)).value().id, 1U);
  EXPECT_FALSE(selector.Add(TrackedAt(0.51, 0.34)).has_value());
  const std::optional<Keyframe> turned = selector.Add(TrackedAt(0.51, 0.36));
  ASSERT_TRUE(turned.has_value());
  EXPECT_EQ(turned->id, 2U);
  EXPECT_EQ(turned->points.size(), 5U);
}

TEST(KeyframeSelectorTest, ANewSegmentBeginsWithAKeyframe) {
  KeyframeSelector selector(0.5, 20.0);
  selector.Add(TrackedAt(0.0, 0.0));
  const std::optional<Keyframe> first = selector.Add(TrackedAt(0.1, 0.0, 1));
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->segment, 1U);
}

TEST(KeyframeSelectorTest, ScansThatAreNotTrackedAreNone) {
  KeyframeSelector selector(0.5, 20.0);
  ScanResult result = TrackedAt(0.0, 0.0);
  result.status = ScanStatus::kImuOnly;
  EXPECT_FALSE(selector.Add(result).has_value());
}

}  // namespace
}  // namespace hv::lio
