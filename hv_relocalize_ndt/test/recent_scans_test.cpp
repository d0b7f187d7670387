#include "hv_relocalize_ndt/recent_scans.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace hv::relocalize {
namespace {

constexpr float kNear_m = 2e-3F;

/// The sensor after `step` steps of half a metre on a bend.
Pose PoseAt(int step) {
  return MakePose(RotationFromRpy(0.02, -0.01, 0.1 * step), {0.5 * step, 0.02 * step * step, 0.3});
}

/// A mark that only the scan of this step sees, in the frame of odometry.
Eigen::Vector3d MarkOf(int step) { return {0.5 * step + 0.05, -3.05, 1.05}; }

std::vector<Eigen::Vector3f> ScanAt(int step) {
  return {(PoseAt(step).inverse() * MarkOf(step)).cast<float>()};
}

bool Shows(const std::vector<Eigen::Vector3f>& cloud, const Eigen::Vector3d& position) {
  return std::any_of(cloud.begin(), cloud.end(), [&](const Eigen::Vector3f& point) {
    return (point - position.cast<float>()).norm() < kNear_m;
  });
}

class RecentScansTest : public testing::Test {
 protected:
  void Drive(int steps) {
    for (int step = 0; step < steps; ++step) recent_.Add(ScanAt(step), PoseAt(step));
  }

  RecentScansConfig config_;
  RecentScans recent_{config_};
};

TEST_F(RecentScansTest, JoinsWhatWasSeenOnTheWayInTheFrameOfTheSensor) {
  Drive(4);
  const Pose here = PoseAt(4);
  ASSERT_TRUE(recent_.Extends(here));
  const std::vector<Eigen::Vector3f> cloud = recent_.Join(ScanAt(4), here);
  EXPECT_EQ(cloud.size(), 5U);
  for (int step = 0; step <= 4; ++step) {
    EXPECT_TRUE(Shows(cloud, here.inverse() * MarkOf(step))) << step;
  }
}

TEST_F(RecentScansTest, KeepsTheLastOnes) {
  constexpr int kLast = 30;
  Drive(kLast);
  const Pose here = PoseAt(kLast);
  const std::vector<Eigen::Vector3f> cloud = recent_.Join(ScanAt(kLast), here);
  EXPECT_EQ(cloud.size(), static_cast<std::size_t>(config_.scans));
  EXPECT_TRUE(Shows(cloud, here.inverse() * MarkOf(kLast - config_.scans + 1)));
  EXPECT_FALSE(Shows(cloud, here.inverse() * MarkOf(kLast - config_.scans)));
}

TEST_F(RecentScansTest, WhereItStandsASingleScanIsAllThereIs) {
  for (int i = 0; i < 50; ++i) recent_.Add(ScanAt(0), PoseAt(0));
  EXPECT_FALSE(recent_.Extends(PoseAt(0)));
  EXPECT_EQ(recent_.Join(ScanAt(0), PoseAt(0)).size(), 1U);
}

TEST_F(RecentScansTest, NothingIsLeftOnceCleared) {
  Drive(4);
  recent_.Clear();
  EXPECT_FALSE(recent_.Extends(PoseAt(4)));
  recent_.Add({}, PoseAt(4));
  EXPECT_FALSE(recent_.Extends(PoseAt(9)));
}

TEST_F(RecentScansTest, OneScanMeansEachAlone) {
  config_.scans = 1;
  RecentScans alone(config_);
  for (int step = 0; step < 4; ++step) alone.Add(ScanAt(step), PoseAt(step));
  EXPECT_FALSE(alone.Extends(PoseAt(4)));
}

}  // namespace
}  // namespace hv::relocalize
