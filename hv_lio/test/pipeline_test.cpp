#include "hv_lio/pipeline.h"

#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "box_room.h"
#include "hv_lio/imu_predictor.h"

namespace hv::lio {
namespace {

constexpr double kGravity = 9.80665;
constexpr double kStart = 1000.0;
constexpr double kRest = 1.5;

/// Rests, then swings through the room while turning; everything analytic.
struct Swing {
  static double Phase(double time) { return std::max(0.0, time - kStart - kRest); }

  static Pose PoseAt(double time) {
    const double u = Phase(time);
    const double yaw = 0.6 * (1.0 - std::cos(0.7 * u));
    return MakePose(RotationFromRpy(0.0, 0.0, yaw),
                    {1.2 * (1.0 - std::cos(0.9 * u)), 0.8 * (1.0 - std::cos(0.5 * u)), 0.0});
  }

  static ImuSample ImuAt(double time) {
    const double u = Phase(time);
    const bool moving = u > 0.0;
    ImuSample sample;
    sample.stamp = Time::FromSeconds(time);
    sample.angular_velocity.z() = 0.6 * 0.7 * std::sin(0.7 * u);
    const Eigen::Vector3d acceleration(moving ? 1.2 * 0.81 * std::cos(0.9 * u) : 0.0,
                                       moving ? 0.8 * 0.25 * std::cos(0.5 * u) : 0.0, 0.0);
    sample.acceleration = PoseAt(time).linear().transpose() *
                          (acceleration + Eigen::Vector3d(0.0, 0.0, kGravity));
    return sample;
  }
};

/// Feeds a pipeline with the swing; the hooks may alter or swallow what is sent.
struct Drive {
  explicit Drive(const LioConfig& config = LioConfig()) : pipeline(config) {}

  Pipeline pipeline;
  ImuPredictor predictor{ImuNoiseConfig()};
  BoxRoom room;
  std::mt19937 random{7};
  std::function<bool(ImuSample&)> imu_hook = [](ImuSample&) { return true; };
  std::function<bool(Scan&)> scan_hook = [](Scan&) { return true; };
  std::vector<ScanResult> results;
  std::vector<OdometryEstimate> predictions;

  void Collect() {
    while (const std::optional<ScanResult> result = pipeline.ProcessNext()) {
      results.push_back(*result);
      if (result->status == ScanStatus::kTracking) predictor.Anchor(result->estimate);
    }
  }

  void Run(double from, double to) {
    const int first = static_cast<int>(std::lround(from * 200.0));
    const int last = static_cast<int>(std::lround(to * 200.0));
    for (int tick = first; tick < last; ++tick) {
      const double time = kStart + tick / 200.0;
      ImuSample sample = Swing::ImuAt(time);
      if (imu_hook(sample)) {
        pipeline.AddImu(sample);
        if (const auto prediction = predictor.Add(sample)) predictions.push_back(*prediction);
      }
      if (tick % 20 == 0) {
        Scan scan = room.Sweep(time, Swing::PoseAt, 0.01, random);
        if (scan_hook(scan)) pipeline.AddScan(std::move(scan));
      }
      Collect();
    }
  }

  /// Largest position error of tracked scans against the truth [m]; the odom frame starts at the
  /// truth's origin. `shift` is subtracted from stamps first.
  double WorstError(double shift = 0.0) const {
    double worst = results.empty() ? std::numeric_limits<double>::infinity() : 0.0;
    for (const ScanResult& result : results) {
      if (result.status != ScanStatus::kTracking) continue;
      const Pose truth = Swing::PoseAt(result.estimate.stamp.seconds() - shift);
      worst = std::max(
          worst, (result.estimate.T_odom_imu.translation() - truth.translation()).norm());
    }
    return worst;
  }

  std::size_t Tracked() const { return pipeline.counters().scans_tracked; }
};

TEST(PipelineTest, FollowsTheTruth) {
  Drive drive;
  drive.Run(0.0, 6.0);
  EXPECT_GT(drive.Tracked(), 45U);
  EXPECT_LT(drive.WorstError(), 0.01);
  const OdometryEstimate& last = drive.results.back().estimate;
  EXPECT_LT(RotationDistance(last.T_odom_imu, Swing::PoseAt(last.stamp.seconds())), 0.003);
  EXPECT_EQ(last.pose_covariance.llt().info(), Eigen::Success);
  EXPECT_EQ(last.twist_covariance.llt().info(), Eigen::Success);
}

TEST(PipelineTest, OneThreadAndManyAgree) {
  LioConfig many;
  many.threads = 4;
  Drive serial;
  Drive parallel(many);
  serial.Run(0.0, 5.0);
  parallel.Run(0.0, 5.0);
  ASSERT_EQ(serial.results.size(), parallel.results.size());
  for (std::size_t i = 0; i < serial.results.size(); ++i) {
    const Pose difference = serial.results[i].estimate.T_odom_imu.inverse() *
                            parallel.results[i].estimate.T_odom_imu;
    EXPECT_LT(difference.translation().norm(), 1e-6);
  }
}

TEST(PipelineTest, PredictionsRunAtImuRateAndMeetTheCorrectedPoses) {
  Drive drive;
  drive.Run(0.0, 5.0);
  ASSERT_GT(drive.predictions.size(), 600U);
  double worst = 0.0;
  for (const OdometryEstimate& prediction : drive.predictions) {
    const Pose truth = Swing::PoseAt(prediction.stamp.seconds());
    worst = std::max(worst,
                     (prediction.T_odom_imu.translation() - truth.translation()).norm());
  }
  EXPECT_LT(worst, 0.02);
}

TEST(PipelineTest, AccelerationInUnitsOfGIsRecognised) {
  Drive drive;
  drive.imu_hook = [](ImuSample& sample) {
    sample.acceleration /= kGravity;
    return true;
  };
  drive.Run(0.0, 4.0);
  EXPECT_GT(drive.Tracked(), 25U);
  EXPECT_LT(drive.WorstError(), 0.01);
}

TEST(PipelineTest, WithoutImuItWaitsAndSaysSo) {
  Drive drive;
  drive.imu_hook = [](ImuSample&) { return false; };
  drive.Run(0.0, 4.0);
  EXPECT_EQ(drive.Tracked(), 0U);
  ASSERT_FALSE(drive.results.empty());
  EXPECT_EQ(drive.results.back().status, ScanStatus::kInitializing);
  EXPECT_EQ(drive.results.back().reason, "waiting for IMU samples");
}

TEST(PipelineTest, RunsWithoutAnImuWhenToldTo) {
  LioConfig config;
  config.use_imu = false;
  Drive drive(config);
  drive.imu_hook = [](ImuSample&) { return false; };
  drive.Run(0.0, 6.0);
  EXPECT_GT(drive.Tracked(), 50U);
  EXPECT_LT(drive.WorstError(), 0.03);
}

/// The first data already move: velocity and tilt have to come out of the scans.
TEST(PipelineTest, StartsInMotion) {
  LioConfig config;
  config.initialization.static_accel_std = 1e-4;
  Drive drive(config);
  drive.Run(3.0, 12.0);
  const OdometryEstimate& last = drive.results.back().estimate;
  const Pose truth = Swing::PoseAt(last.stamp.seconds());
  const Pose before = Swing::PoseAt(last.stamp.seconds() - 0.001);
  const Eigen::Vector3d velocity =
      truth.linear().transpose() * (truth.translation() - before.translation()) / 0.001;
  EXPECT_EQ(drive.results.back().status, ScanStatus::kTracking);
  EXPECT_LT((last.T_odom_imu.linear().transpose() * last.velocity_odom - velocity).norm(), 0.05);
  const Eigen::Vector3d up_odom =
      last.T_odom_imu.linear() * truth.linear().transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_LT((up_odom - Eigen::Vector3d::UnitZ()).norm(), 0.02);
}

TEST(PipelineTest, BridgesAnImuGap) {
  Drive drive;
  drive.imu_hook = [](ImuSample& sample) {
    const double time = sample.stamp.seconds() - kStart;
    return time < 3.0 || time > 3.4;
  };
  drive.Run(0.0, 6.0);
  EXPECT_EQ(drive.pipeline.counters().imu_gaps, 1U);
  EXPECT_GT(drive.Tracked(), 45U);
  EXPECT_LT(drive.WorstError(), 0.03);
}

TEST(PipelineTest, SurvivesLostScans) {
  Drive drive;
  drive.scan_hook = [](Scan& scan) {
    const double time = scan.stamp.seconds() - kStart;
    return time < 3.0 || time > 4.0;
  };
  drive.Run(0.0, 6.0);
  EXPECT_LT(drive.WorstError(), 0.03);
}

TEST(PipelineTest, EmptyAndNotFiniteScansLeaveThePrediction) {
  Drive drive;
  drive.scan_hook = [](Scan& scan) {
    const int number = static_cast<int>(std::lround((scan.stamp.seconds() - kStart) * 10.0));
    if (number == 30 || number == 31) scan.points.clear();
    if (number == 35) {
      for (Point& point : scan.points) point.x = std::numeric_limits<float>::quiet_NaN();
    }
    return true;
  };
  drive.Run(0.0, 6.0);
  EXPECT_EQ(drive.pipeline.counters().scans_imu_only, 3U);
  EXPECT_LT(drive.WorstError(), 0.02);
}

TEST(PipelineTest, NotFiniteImuSamplesAreCountedAndIgnored) {
  Drive drive;
  int count = 0;
  drive.imu_hook = [&count](ImuSample& sample) {
    if (++count % 50 == 0) sample.acceleration.x() = std::numeric_limits<double>::infinity();
    return true;
  };
  drive.Run(0.0, 4.0);
  EXPECT_EQ(drive.pipeline.counters().imu_invalid, 16U);
  EXPECT_LT(drive.WorstError(), 0.01);
}

class ClockJumpTest : public ::testing::TestWithParam<double> {};

TEST_P(ClockJumpTest, GoesOnFromTheSamePose) {
  Drive drive;
  drive.Run(0.0, 4.0);
  const std::size_t before = drive.Tracked();
  const auto shift = [](Time time) { return time + GetParam(); };
  drive.imu_hook = [&shift](ImuSample& sample) {
    sample.stamp = shift(sample.stamp);
    return true;
  };
  drive.scan_hook = [&shift](Scan& scan) {
    scan.stamp = shift(scan.stamp);
    return true;
  };
  drive.Run(4.0, 4.05);
  drive.results.clear();
  drive.Run(4.05, 7.0);
  EXPECT_GE(drive.pipeline.counters().clock_jumps, 1U);
  EXPECT_GT(drive.Tracked(), before + 25);
  EXPECT_LT(drive.WorstError(GetParam()), 0.03);
}

INSTANTIATE_TEST_SUITE_P(Steps, ClockJumpTest, ::testing::Values(-500.0, -5.0, 60.0, 1e6));

TEST(PipelineTest, ResetKeepsOdomContinuous) {
  Drive drive;
  drive.Run(0.0, 3.5);
  const Pose before = drive.results.back().estimate.T_odom_imu;
  drive.pipeline.Reset(true);
  EXPECT_EQ(drive.pipeline.map().size(), 0U);
  drive.Run(3.5, 8.0);
  const auto first = std::find_if(
      drive.results.begin(), drive.results.end(), [&](const ScanResult& result) {
        return result.status == ScanStatus::kTracking &&
               result.estimate.stamp.seconds() > kStart + 3.6;
      });
  ASSERT_NE(first, drive.results.end());
  EXPECT_LT((first->estimate.T_odom_imu.translation() - before.translation()).norm(), 0.05);
}

TEST(PipelineTest, OldScansAreDropped) {
  Drive drive;
  drive.Run(0.0, 3.0);
  Scan old = drive.room.Sweep(kStart + 2.0, Swing::PoseAt, 0.0, drive.random);
  drive.pipeline.AddScan(old);
  drive.Collect();
  EXPECT_EQ(drive.results.back().status, ScanStatus::kDropped);
  EXPECT_EQ(drive.pipeline.counters().scans_dropped, 1U);
}

/// Without end walls nothing tells where along x the sensor is.
TEST(PipelineTest, LongTunnelIsReportedDegenerateAlongItsAxis) {
  Drive drive;
  drive.room.low.x() = -1e4;
  drive.room.high.x() = 1e4;
  drive.scan_hook = [](Scan& scan) {
    const auto far = [](const Point& point) { return std::abs(point.x) > 40.0F; };
    scan.points.erase(std::remove_if(scan.points.begin(), scan.points.end(), far),
                      scan.points.end());
    return true;
  };
  drive.Run(0.0, 6.0);
  const ScanResult& last = drive.results.back();
  ASSERT_EQ(last.update.degenerate_translation.size(), 1U);
  EXPECT_GT(std::abs(last.update.degenerate_translation[0].x()), 0.99);
  const Matrix6d& covariance = last.estimate.pose_covariance;
  EXPECT_GT(covariance(0, 0), 100.0 * covariance(1, 1));
  const double error = last.estimate.T_odom_imu.translation().x() -
                       Swing::PoseAt(last.estimate.stamp.seconds()).translation().x();
  EXPECT_LT(std::abs(error), 3.0 * std::sqrt(covariance(0, 0)));
}

TEST(PipelineTest, InvalidConfigurationIsRefused) {
  LioConfig config;
  config.threads = 0;
  EXPECT_THROW(Pipeline{config}, InputError);
}

}  // namespace
}  // namespace hv::lio
