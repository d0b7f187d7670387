#include "hv_loop_btc/odometry_model.h"

#include <random>

#include <gtest/gtest.h>

namespace hv::loop {
namespace {

constexpr int kRound = 60;  // keyframes of one round, a metre apart

/// Three rounds of a circle; odometry sees every metre with an error.
class OdometryModelTest : public ::testing::Test {
 protected:
  void Drive(const SystematicDrift& error, double noise_rad = 0.0) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, noise_rad);
    Pose T_odom_imu = Pose::Identity();
    for (int i = 0; i < 3 * kRound; ++i) {
      Keyframe keyframe;
      keyframe.id = static_cast<std::uint32_t>(i);
      keyframe.T_odom_imu = T_odom_imu;
      keyframe.gravity_odom = Eigen::Vector3d(0.0, 0.0, -9.81);
      model.AddKeyframe(keyframe);
      const Pose noisy =
          Step() * MakePose(RotationFromRpy(0.0, 0.0, noise(random)), Eigen::Vector3d::Zero());
      T_odom_imu = T_odom_imu * error.Correct(noisy, Eigen::Vector3d::UnitZ());
    }
  }

  /// True loops: the same place one and two rounds earlier.
  void Close(int loops) {
    for (int i = 0; i < loops; ++i) {
      const auto to = static_cast<std::uint32_t>(3 * kRound - 1 - 5 * i);
      const auto from = static_cast<std::uint32_t>(to - (i % 2 + 1) * kRound);
      model.AddLoop(from, to, Pose::Identity());
    }
  }

  static Pose Step() {
    return MakePose(RotationFromRpy(0.0, 0.0, 2.0 * M_PI / kRound), {1.0, 0.0, 0.0});
  }

  OdometryModel model{OdometryEdgeConfig()};
};

TEST_F(OdometryModelTest, TakesOutDriftOfTheHeading) {
  Drive({0.0, 0.003});
  Close(12);
  EXPECT_TRUE(model.Learn());
  EXPECT_NEAR(model.drift().heading_rad_per_m, -0.003, 1e-4);
  GraphEdge edge;
  edge.from = 10;
  edge.T_from_to = SystematicDrift{0.0, 0.003}.Correct(Step(), Eigen::Vector3d::UnitZ());
  EXPECT_LT(RotationDistance(model.Corrected(edge).T_from_to, Step()), 1e-4);
}

TEST_F(OdometryModelTest, CorrectionIsUndoneByItsOpposite) {
  const Pose step = MakePose(RotationFromRpy(0.1, -0.2, 0.3), {0.5, 0.2, -0.1});
  const Eigen::Vector3d up = Eigen::Vector3d(0.1, -0.2, 1.0).normalized();
  const Pose there = SystematicDrift{0.0, 0.01}.Correct(step, up);
  const Pose back = SystematicDrift{0.0, -0.01}.Correct(there, up);
  EXPECT_LT(RotationDistance(back, step), 1e-9);
  EXPECT_LT((back.translation() - step.translation()).norm(), 1e-9);
}

TEST_F(OdometryModelTest, LoopsThatAgreeShowNoDriftAndLessNoise) {
  Drive({});
  Close(12);
  EXPECT_TRUE(model.Learn());
  EXPECT_EQ(model.drift().heading_rad_per_m, 0.0);
  EXPECT_EQ(model.drift().stretch, 0.0);
  EXPECT_LT(model.rotation_scale(), 0.5);
  EXPECT_FALSE(model.Learn());
}

TEST_F(OdometryModelTest, NoiseIsNotTakenForDrift) {
  Drive({}, 0.02);
  Close(12);
  EXPECT_TRUE(model.Learn());
  EXPECT_LT(std::abs(model.drift().heading_rad_per_m), 0.003);
  EXPECT_GT(model.rotation_scale(), 10.0);
  GraphEdge edge;
  edge.from = 10;
  const double scale = model.rotation_scale();
  EXPECT_NEAR(model.Corrected(edge).information(5, 5), 1.0 / (scale * scale), 1e-12);
}

TEST_F(OdometryModelTest, OneFalseLoopAmongGoodOnesSetsNothing) {
  Drive({});
  Close(12);
  model.Learn();
  model.AddLoop(3, 170, MakePose(RotationFromRpy(0.0, 0.0, 1.0), {20.0, 0.0, 0.0}));
  EXPECT_FALSE(model.Learn());
}

TEST_F(OdometryModelTest, FewLoopsShowNoDrift) {
  Drive({0.0, 0.003});
  Close(3);
  EXPECT_TRUE(model.Learn());
  EXPECT_EQ(model.drift().heading_rad_per_m, 0.0);
  EXPECT_GT(model.rotation_scale(), 1.0);
}

}  // namespace
}  // namespace hv::loop
