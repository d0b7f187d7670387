#include "hv_replay/trajectory_error.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "hv_core/so3.h"

namespace hv::replay {
namespace {

constexpr std::int64_t kStartNs = 1646310000000000000;

/// A climbing helix of 10 m radius: 100 s at 10 Hz, about 126 m long.
Pose TruthAt(double t) {
  const double angle = 0.12566370614359174 * t;
  return MakePose(RotationFromRpy(0.05 * std::sin(t), 0.03 * std::cos(t), angle),
                  Eigen::Vector3d(10.0 * std::cos(angle), 10.0 * std::sin(angle), 0.02 * t));
}

Trajectory Truth(double period = 0.1, double offset = 0.0) {
  Trajectory trajectory;
  for (double t = offset; t < 100.0; t += period) {
    trajectory.Append(Time::FromNanoseconds(kStartNs) + t, TruthAt(t));
  }
  return trajectory;
}

Trajectory Transformed(const Pose& T_new_old, const Trajectory& trajectory) {
  Trajectory result;
  for (const StampedPose& pose : trajectory.poses()) {
    result.Append(pose.stamp, T_new_old * pose.pose);
  }
  return result;
}

/// Every position moved by Gaussian noise of `sigma` along each axis.
Trajectory Noisy(const Trajectory& trajectory, const Eigen::Vector3d& sigma) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  Trajectory result;
  for (const StampedPose& pose : trajectory.poses()) {
    const Eigen::Vector3d noise(normal(random), normal(random), normal(random));
    Pose moved = pose.pose;
    moved.translation() += sigma.cwiseProduct(noise);
    result.Append(pose.stamp, moved);
  }
  return result;
}

TrajectoryErrorOptions With(Alignment alignment) {
  TrajectoryErrorOptions options;
  options.alignment = alignment;
  return options;
}

TEST(Statistics, AgreeWithHandComputedValues) {
  const Statistics statistics = Summarize({4.0, 1.0, 2.0, 5.0});
  EXPECT_EQ(statistics.count, 4U);
  EXPECT_DOUBLE_EQ(statistics.max, 5.0);
  EXPECT_DOUBLE_EQ(statistics.mean, 3.0);
  EXPECT_DOUBLE_EQ(statistics.median, 3.0);
  EXPECT_DOUBLE_EQ(statistics.rmse, std::sqrt(46.0 / 4.0));
  EXPECT_DOUBLE_EQ(statistics.std, std::sqrt(10.0 / 4.0));
  EXPECT_DOUBLE_EQ(Summarize({3.0, 9.0, 1.0}).median, 3.0);
  EXPECT_EQ(Summarize({}).count, 0U);
}

TEST(TrajectoryError, IdenticalTrajectoriesHaveNone) {
  for (const Alignment alignment : {Alignment::kSe3, Alignment::kYaw, Alignment::kNone}) {
    const TrajectoryError error = CompareTrajectories(Truth(), Truth(), With(alignment));
    EXPECT_EQ(error.matched.size(), error.reference_poses);
    EXPECT_LT(error.translation.max, 1e-9);
    EXPECT_LT(error.rotation.max, 1e-5);
    EXPECT_NEAR(error.path_length_m, 125.5, 1.0);
    EXPECT_LT(error.relative[0].translation.max, 1e-9);
  }
}

TEST(TrajectoryError, Se3RemovesAnyRigidTransform) {
  const Pose moved = MakePose(RotationFromRpy(0.5, -1.0, 2.5), Eigen::Vector3d(100, -50, 7));
  const TrajectoryError error =
      CompareTrajectories(Truth(), Transformed(moved, Truth()), With(Alignment::kSe3));
  EXPECT_LT(error.translation.max, 1e-9);
  EXPECT_LT(error.rotation.max, 1e-5);
  EXPECT_TRUE((error.T_reference_estimate * moved).isApprox(Pose::Identity(), 1e-9));
}

TEST(TrajectoryError, YawRemovesYawAndTranslationOnly) {
  const Pose yawed = MakePose(RotationFromRpy(0.0, 0.0, 2.5), Eigen::Vector3d(100, -50, 7));
  const TrajectoryError none =
      CompareTrajectories(Truth(), Transformed(yawed, Truth()), With(Alignment::kYaw));
  EXPECT_LT(none.translation.max, 1e-9);

  const double tilt = 0.02;
  const Pose tilted = MakePose(RotationFromRpy(tilt, 0.0, 0.0), Eigen::Vector3d::Zero());
  const TrajectoryError left =
      CompareTrajectories(Truth(), Transformed(tilted, Truth()), With(Alignment::kYaw));
  EXPECT_NEAR(left.vertical.max, 10.0 * std::sin(tilt), 0.02);
  EXPECT_NEAR(left.rotation.mean, tilt * 180.0 / M_PI, 0.02);
}

TEST(TrajectoryError, NoneKeepsTheOffset) {
  const Pose moved = MakePose(RotationFromRpy(0.0, 0.0, 0.0), Eigen::Vector3d(3.0, 0.0, 4.0));
  const TrajectoryError error =
      CompareTrajectories(Truth(), Transformed(moved, Truth()), With(Alignment::kNone));
  EXPECT_NEAR(error.translation.rmse, 5.0, 1e-9);
  EXPECT_NEAR(error.translation.std, 0.0, 1e-9);
  EXPECT_NEAR(error.horizontal.mean, 3.0, 1e-9);
  EXPECT_NEAR(error.vertical.mean, 4.0, 1e-9);
  EXPECT_NEAR(error.axis_rmse.x(), 3.0, 1e-9);
  EXPECT_NEAR(error.axis_rmse.y(), 0.0, 1e-9);
}

TEST(TrajectoryError, NoiseComesBackAsItsRmse) {
  const Eigen::Vector3d sigma(0.02, 0.04, 0.08);
  for (const Alignment alignment : {Alignment::kSe3, Alignment::kYaw, Alignment::kNone}) {
    const TrajectoryError error =
        CompareTrajectories(Truth(), Noisy(Truth(), sigma), With(alignment));
    EXPECT_NEAR(error.translation.rmse, sigma.norm(), 0.05 * sigma.norm());
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(error.axis_rmse[axis], sigma[axis], 0.06 * sigma[axis]);
    }
    EXPECT_NEAR(error.vertical.rmse, error.axis_rmse.z(), 1e-12);
  }
}

TEST(TrajectoryError, Se3AlignmentIsOptimal) {
  const Trajectory estimate = Noisy(Truth(), Eigen::Vector3d(0.1, 0.1, 0.1));
  const double best =
      CompareTrajectories(Truth(), estimate, With(Alignment::kSe3)).translation.rmse;
  for (int axis = 0; axis < 6; ++axis) {
    for (const double step : {-1e-3, 1e-3}) {
      Vector6d xi = Vector6d::Zero();
      xi[axis] = step;
      const TrajectoryError aligned = CompareTrajectories(Truth(), estimate, With(Alignment::kSe3));
      const Pose other = aligned.T_reference_estimate * se3::Exp(xi);
      const TrajectoryError error =
          CompareTrajectories(Truth(), Transformed(other, estimate), With(Alignment::kNone));
      EXPECT_GT(error.translation.rmse, best) << axis;
    }
  }
}

TEST(TrajectoryError, RotationErrorIsTheAngle) {
  Trajectory turned;
  const double angle = 2.0 * M_PI / 180.0;
  const Trajectory truth = Truth();
  for (const StampedPose& pose : truth.poses()) {
    turned.Append(pose.stamp,
                  pose.pose * MakePose(RotationFromRpy(0, 0, angle), Eigen::Vector3d::Zero()));
  }
  const TrajectoryError error = CompareTrajectories(Truth(), turned, With(Alignment::kSe3));
  EXPECT_NEAR(error.rotation.mean, 2.0, 1e-6);
  EXPECT_NEAR(error.rotation.max, 2.0, 1e-6);
  EXPECT_LT(error.translation.max, 1e-9);
}

TEST(TrajectoryError, ScaledPathGivesItsRelativeError) {
  Trajectory line, longer;
  for (int i = 0; i <= 1000; ++i) {
    const Time stamp = Time::FromNanoseconds(kStartNs + i * 100000000LL);
    const double x = 0.05 * i;
    line.Append(stamp, MakePose(RotationFromRpy(0, 0, 0), Eigen::Vector3d(x, 0, 0)));
    longer.Append(stamp, MakePose(RotationFromRpy(0, 0, 0), Eigen::Vector3d(1.02 * x, 0, 0)));
  }
  TrajectoryErrorOptions options = With(Alignment::kNone);
  options.rpe_lengths_m = {1.0, 10.0, 1000.0};
  const TrajectoryError error = CompareTrajectories(line, longer, options);
  EXPECT_NEAR(error.relative[0].translation.mean, 0.02, 1.1e-3);
  EXPECT_NEAR(error.relative[1].translation.mean, 0.2, 1.1e-3);
  EXPECT_EQ(error.relative[2].translation.count, 0U);
}

TEST(TrajectoryError, InterpolatesTheReferenceBetweenItsStamps) {
  const TrajectoryError error =
      CompareTrajectories(Truth(0.1), Truth(0.1, 0.037), With(Alignment::kNone));
  EXPECT_GT(error.matched.size(), 990U);
  EXPECT_LT(error.translation.max, 1e-3);
}

TEST(TrajectoryError, SparseReferenceIsMetByInterpolatingTheEstimate) {
  const TrajectoryError error =
      CompareTrajectories(Truth(7.013), Truth(0.1), With(Alignment::kNone));
  EXPECT_EQ(error.matched.size(), error.reference_poses);
  EXPECT_LT(error.translation.max, 1e-3);
}

TEST(TrajectoryError, DoesNotBridgeGapsOfTheReference) {
  Trajectory broken;
  const Trajectory truth = Truth();
  for (const StampedPose& pose : truth.poses()) {
    const double t = pose.stamp - Time::FromNanoseconds(kStartNs);
    if (t < 20.0 || t > 60.0) broken.Append(pose.stamp, pose.pose);
  }
  const TrajectoryError error =
      CompareTrajectories(broken, Truth(0.1, 0.05), With(Alignment::kSe3));
  EXPECT_NEAR(static_cast<double>(error.matched.size()), 600.0, 3.0);
  EXPECT_LT(error.translation.max, 2e-3);
}

TEST(TrajectoryError, TooFewMatchesAreAnErrorThatNamesTheTimes) {
  Trajectory late;
  late.Append(Time::FromNanoseconds(kStartNs) + 1000.0, Pose::Identity());
  try {
    CompareTrajectories(Truth(), late, With(Alignment::kSe3));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("0 matched poses"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("1646311000.000000000"), std::string::npos);
  }
  EXPECT_THROW(CompareTrajectories(Trajectory(), Trajectory(), With(Alignment::kNone)), InputError);
}

TEST(TrajectoryError, StraightAndSinglePointPathsStayFinite) {
  Trajectory line, point;
  for (int i = 0; i < 50; ++i) {
    const Time stamp = Time::FromNanoseconds(kStartNs + i * 100000000LL);
    line.Append(stamp, MakePose(RotationFromRpy(0, 0, 0), Eigen::Vector3d(0.1 * i, 0, 0)));
    point.Append(stamp, Pose::Identity());
  }
  for (const Trajectory& path : {line, point}) {
    for (const Alignment alignment : {Alignment::kSe3, Alignment::kYaw}) {
      const TrajectoryError error = CompareTrajectories(path, path, With(alignment));
      EXPECT_LT(error.translation.max, 1e-9);
      EXPECT_NEAR(error.T_reference_estimate.linear().determinant(), 1.0, 1e-9);
    }
  }
}

TEST(Alignment, NamesAreParsed) {
  EXPECT_EQ(ParseAlignment("yaw"), Alignment::kYaw);
  EXPECT_THROW(ParseAlignment("sim3"), InputError);
}

}  // namespace
}  // namespace hv::replay
