#include "hv_loop_btc/loop_closer.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "town.h"

namespace hv::loop {
namespace {

/// Two rounds on a circle through the town, with odometry whose heading drifts.
struct Rounds {
  static constexpr int kPerRound = 60;
  static constexpr double kRadius = 8.0;

  explicit Rounds(double drift_rad_per_step) : drift(drift_rad_per_step) {}

  static Pose TruthAt(int i) {
    const double angle = 2.0 * M_PI * i / kPerRound;
    return SensorPose(kRadius * std::cos(angle), kRadius * std::sin(angle), angle + M_PI / 2.0);
  }

  Keyframe Next() {
    const Pose truth = TruthAt(next);
    if (next > 0) {
      const Pose step = TruthAt(next - 1).inverse() * truth;
      odometry = odometry * step * MakePose(RotationFromRpy(0, 0, drift), Eigen::Vector3d::Zero());
      worst_odometry_error = std::max(
          worst_odometry_error, (odometry.translation() - truth.translation()).norm());
    }
    Keyframe keyframe;
    keyframe.id = static_cast<std::uint32_t>(next);
    keyframe.stamp = Time::FromSeconds(100.0 + next);
    keyframe.T_odom_imu = odometry;
    keyframe.covariance = 1e-6 * Matrix6d::Identity();
    for (const Eigen::Vector3f& p : town.Seen(truth, 12.0, 8.0, random)) {
      Point point;
      point.x = p.x();
      point.y = p.y();
      point.z = p.z();
      keyframe.points.push_back(point);
    }
    ++next;
    return keyframe;
  }

  Town town{21, 25};
  std::mt19937 random{6};
  double drift;
  int next = 0;
  Pose odometry = TruthAt(0);
  double worst_odometry_error = 0.0;
};

class LoopCloserTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("hv_loop_closer_test_" + std::to_string(getpid()));
    store_ = std::make_unique<KeyframeStore>(folder_.string(), KeyframeStoreConfig(),
                                             Eigen::Vector3d::Zero());
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }

  /// Largest distance of corrected keyframes from the truth [m].
  static double WorstError(const LoopCloser& closer) {
    double worst = 0.0;
    for (const GraphVertex& vertex : closer.graph().Poses()) {
      const Pose truth = Rounds::TruthAt(static_cast<int>(vertex.id));
      worst = std::max(worst, (vertex.T_map_imu.translation() - truth.translation()).norm());
    }
    return worst;
  }

  std::filesystem::path folder_;
  std::unique_ptr<KeyframeStore> store_;
};

TEST_F(LoopCloserTest, DriftIsTakenOutWhenThePlaceIsSeenAgain) {
  LoopCloser closer(LoopConfig(), *store_);
  Rounds rounds(0.003);
  for (int i = 0; i < 2 * Rounds::kPerRound; ++i) closer.Add(rounds.Next());
  closer.Finish();
  EXPECT_GT(rounds.worst_odometry_error, 2.0);
  EXPECT_LT(WorstError(closer), 0.2 * rounds.worst_odometry_error);
  int accepted = 0;
  for (const LoopCandidate& loop : closer.candidates()) {
    EXPECT_EQ(loop.accepted, loop.reason.empty()) << loop.reason;
    if (!loop.accepted) continue;
    ++accepted;
    const Pose truth = Rounds::TruthAt(static_cast<int>(loop.match)).inverse() *
                       Rounds::TruthAt(static_cast<int>(loop.query));
    EXPECT_LT((loop.T_match_query.translation() - truth.translation()).norm(), 0.1);
  }
  EXPECT_GE(accepted, 5);
}

TEST_F(LoopCloserTest, AGoodMapStaysAsItIs) {
  LoopCloser closer(LoopConfig(), *store_);
  Rounds rounds(0.0);
  for (int i = 0; i < 2 * Rounds::kPerRound; ++i) closer.Add(rounds.Next());
  closer.Finish();
  EXPECT_LT(WorstError(closer), 0.01);
}

TEST_F(LoopCloserTest, CorrectionIsContinuousBetweenKeyframes) {
  LoopCloser closer(LoopConfig(), *store_);
  Rounds rounds(0.003);
  for (int i = 0; i < 2 * Rounds::kPerRound; ++i) closer.Add(rounds.Next());
  closer.Finish();
  const Pose odometry = rounds.odometry;
  const double end = 100.0 + rounds.next - 1;
  Pose before = closer.Corrected(Time::FromSeconds(end), odometry);
  EXPECT_LT((before.translation() - (closer.T_map_odom() * odometry).translation()).norm(), 1e-6);
  for (double back = 0.01; back < 3.0; back += 0.01) {
    const Pose here = closer.Corrected(Time::FromSeconds(end - back), odometry);
    EXPECT_LT((here.translation() - before.translation()).norm(), 0.02);
    before = here;
  }
}

TEST_F(LoopCloserTest, InvalidConfigurationIsRefused) {
  LoopConfig config;
  config.submap.stride = 0;
  EXPECT_THROW(LoopCloser(config, *store_), InputError);
}

}  // namespace
}  // namespace hv::loop
