#include "hv_relocalize_ndt/localizer.h"

#include <algorithm>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "known_hall.h"

namespace hv::relocalize {
namespace {

constexpr unsigned kHallSeed = 7;
constexpr double kStep_s = 0.5;

/// A robot that drives around the ring of a hall, with odometry that drifts.
class Drive {
 public:
  explicit Drive(unsigned seed) : random_(seed) {}

  Pose T_map_imu() const { return OnRing(angle_, 4.3, angle_ + 1.57, 0.01, -0.02); }

  TrackedScan Next(unsigned hall = kHallSeed) {
    const Pose before = T_map_imu();
    angle_ += 0.06;
    const Pose drift = MakePose(RotationFromRpy(0.0, 0.0, 0.001), {0.003, 0.0, 0.0});
    T_odom_imu_ = T_odom_imu_ * before.inverse() * T_map_imu() * drift;
    return Scan(hall);
  }

  /// Put down elsewhere; odometry does not notice.
  void Carry() { angle_ += 2.5; }
  void RestartOdometry() {
    ++segment_;
    T_odom_imu_ = MakePose(RotationFromRpy(0.01, -0.02, 0.0), {0.0, 0.0, 0.0});
  }
  void Pause(double seconds) { time_s_ += seconds; }
  Time now() const { return Time::FromSeconds(time_s_); }

 private:
  TrackedScan Scan(unsigned hall) {
    time_s_ += kStep_s;
    TrackedScan scan;
    scan.stamp = now();
    scan.T_odom_imu = T_odom_imu_;
    scan.segment = segment_;
    scan.lidar_in_imu = {0.1, 0.0, 0.05};
    Pose T_imu_lidar = Pose::Identity();
    T_imu_lidar.translation() = scan.lidar_in_imu;
    for (const Eigen::Vector3f& point :
         ScanOf(loop::Hall(hall), T_map_imu() * T_imu_lidar, random_)) {
      scan.points.emplace_back(point + scan.lidar_in_imu.cast<float>());
    }
    return scan;
  }

  std::mt19937 random_;
  double angle_ = 0.0;
  double time_s_ = 100.0;
  std::uint32_t segment_ = 0;
  Pose T_odom_imu_ = MakePose(RotationFromRpy(0.01, -0.02, 1.0), {0.0, 0.0, 0.0});
};

/// A few returns of each scan, as of a sensor of few rays.
TrackedScan Sparse(TrackedScan scan) {
  constexpr std::size_t kOneOf = 101;
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < scan.points.size(); i += kOneOf) points.push_back(scan.points[i]);
  scan.points = std::move(points);
  return scan;
}

class LocalizerTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::mt19937 random(51);
    map_ = std::make_unique<PriorMap>("hall", CloudOf(loop::Hall(kHallSeed), random),
                                      RelocalizeConfig());
  }
  static void TearDownTestSuite() { map_.reset(); }

  static void ExpectAt(const LocalizerUpdate& update, const Pose& truth) {
    EXPECT_EQ(update.state, LocalizerState::kTracking) << update.reason;
    EXPECT_LT((update.T_map_imu.translation() - truth.translation()).norm(), 0.03);
    EXPECT_LT(RotationDistance(update.T_map_imu, truth), 0.3 * kRadiansPerDegree);
  }

  static std::unique_ptr<PriorMap> map_;
  Localizer localizer_{LocalizerConfig(), *map_};
  Drive drive_{3};
};

std::unique_ptr<PriorMap> LocalizerTest::map_;

TEST_F(LocalizerTest, DriftIsTakenOut) {
  Pose T_map_odom = Pose::Identity();
  Pose last = Pose::Identity();
  for (int i = 0; i < 40; ++i) {
    const TrackedScan scan = drive_.Next();
    const LocalizerUpdate update = localizer_.Add(scan);
    ExpectAt(update, drive_.T_map_imu());
    EXPECT_TRUE(update.T_map_imu.isApprox(update.T_map_odom * scan.T_odom_imu, 1e-9));
    const double variance = update.covariance.topLeftCorner<3, 3>().trace();
    EXPECT_LT(variance, 0.05 * 0.05);
    if (i == 0) T_map_odom = update.T_map_odom;
    last = update.T_map_odom;
  }
  EXPECT_GT((last.inverse() * T_map_odom).translation().norm(), 0.1);
}

TEST_F(LocalizerTest, SaysThatItIsLostAndFindsBackWhenCarriedAway) {
  for (int i = 0; i < 4; ++i) localizer_.Add(drive_.Next());
  drive_.Carry();
  bool lost = false;
  LocalizerUpdate update;
  for (int i = 0; i < 6; ++i) {
    update = localizer_.Add(drive_.Next());
    lost = lost || update.state == LocalizerState::kLost;
  }
  EXPECT_TRUE(lost);
  ExpectAt(update, drive_.T_map_imu());
}

TEST_F(LocalizerTest, OdometryThatStartsAnewIsNoticed) {
  for (int i = 0; i < 3; ++i) localizer_.Add(drive_.Next());
  drive_.RestartOdometry();
  const LocalizerUpdate update = localizer_.Add(drive_.Next());
  EXPECT_TRUE(update.searched);
  ExpectAt(update, drive_.T_map_imu());
}

TEST_F(LocalizerTest, SilenceIsALoss) {
  localizer_.Add(drive_.Next());
  EXPECT_EQ(localizer_.Wait(drive_.now() + 0.5).state, LocalizerState::kTracking);
  const LocalizerUpdate silent = localizer_.Wait(drive_.now() + 10.0);
  EXPECT_EQ(silent.state, LocalizerState::kLost);
  EXPECT_EQ(silent.reason, "no scan");
  drive_.Pause(10.0);
  const LocalizerUpdate back = localizer_.Add(drive_.Next());
  ExpectAt(back, drive_.T_map_imu());
}

TEST_F(LocalizerTest, SkippedScansCarryThePoseAlong) {
  const auto variance = [](const LocalizerUpdate& update) {
    return update.covariance.topLeftCorner<3, 3>().trace();
  };
  localizer_.Add(drive_.Next());
  LocalizerUpdate skipped;
  for (int i = 0; i < 3; ++i) {
    skipped = localizer_.Skip(drive_.Next());
    EXPECT_FALSE(skipped.registered);
  }
  ExpectAt(skipped, drive_.T_map_imu());
  const LocalizerUpdate compared = localizer_.Add(drive_.Next());
  EXPECT_TRUE(compared.registered);
  EXPECT_LT(variance(compared), variance(skipped));
  drive_.RestartOdometry();
  EXPECT_EQ(localizer_.Skip(drive_.Next()).state, LocalizerState::kLost);
}

TEST_F(LocalizerTest, ForgottenPlacesAreLookedForAtOnce) {
  localizer_.Add(drive_.Next());
  localizer_.Forget();
  const LocalizerUpdate waiting = localizer_.Wait(drive_.now() + 0.1);
  EXPECT_EQ(waiting.state, LocalizerState::kLost);
  EXPECT_FALSE(waiting.reason.empty());
  const LocalizerUpdate found = localizer_.Add(drive_.Next());
  EXPECT_TRUE(found.searched);
  ExpectAt(found, drive_.T_map_imu());
}

TEST_F(LocalizerTest, PosesThatAreNowhereAreALoss) {
  localizer_.Add(drive_.Next());
  TrackedScan nowhere = drive_.Next();
  nowhere.T_odom_imu.translation() = Eigen::Vector3d(1e9, -1e12, 1e15);
  LocalizerUpdate update = localizer_.Add(nowhere);
  EXPECT_NE(update.state, LocalizerState::kTracking);
  localizer_.SetGuess({nowhere.T_odom_imu});
  drive_.Pause(0.5);
  update = localizer_.Add(drive_.Next());
  EXPECT_EQ(update.state, LocalizerState::kLost);
  drive_.Pause(0.5);
  update = localizer_.Add(drive_.Next());
  ExpectAt(update, drive_.T_map_imu());
}

TEST_F(LocalizerTest, AnotherHallIsNeverAPlaceInThisOne) {
  for (int i = 0; i < 5; ++i) {
    const LocalizerUpdate update = localizer_.Add(drive_.Next(kHallSeed + 1));
    EXPECT_EQ(update.state, LocalizerState::kLost);
    EXPECT_FALSE(update.reason.empty());
  }
}

/// Of the hall what lies beyond `from_x` [m].
PriorMap PartOfTheHall(float from_x) {
  std::mt19937 random(9);
  std::vector<Eigen::Vector3f> part;
  for (const Eigen::Vector3f& point : CloudOf(loop::Hall(kHallSeed), random)) {
    if (point.x() > from_x) part.push_back(point);
  }
  return PriorMap("part of the hall", part, RelocalizeConfig());
}

TEST_F(LocalizerTest, WhatTheMapDoesNotKnowContradictsNothing) {
  const PriorMap map = PartOfTheHall(-1.0F);
  LocalizerConfig config;
  config.tracking.drift_translation = 0.02;  // of this odometry
  config.tracking.drift_rotation_deg = 0.3;
  Localizer localizer(config, map);
  localizer.SetGuess({drive_.T_map_imu(), 1.0, 0.2});
  constexpr int kOnceAround = 104;
  double least_fit = 1.0;
  for (int i = 0; i < kOnceAround; ++i) {
    const LocalizerUpdate update = localizer.Add(drive_.Next());
    ASSERT_NE(update.state, LocalizerState::kLost) << update.reason;
    if (update.registered) least_fit = std::min(least_fit, update.score.fit);
    if (i + 1 == kOnceAround) ExpectAt(update, drive_.T_map_imu());
  }
  EXPECT_LT(least_fit, config.tracking.min_agreement);
}

TEST_F(LocalizerTest, OutsideOfTheMapOdometryGoesOnForAWhile) {
  const PriorMap map = PartOfTheHall(0.5F);
  LocalizerConfig config;
  config.tracking.min_overlap = 0.75;
  config.tracking.min_agreement = 0.3;
  config.relocalize.accept.min_overlap = 0.3;
  config.relocalize.accept.min_fit = 0.3;
  config.tracking.drift_translation = 0.2;
  config.tracking.max_sigma_m = 0.2;
  Localizer localizer(config, map);
  localizer.SetGuess({drive_.T_map_imu(), 1.0, 0.2});
  bool alone = false;
  LocalizerUpdate update;
  for (int i = 0; i < 60 && !(alone && update.state == LocalizerState::kLost); ++i) {
    update = localizer.Add(drive_.Next());
    alone = alone || update.state == LocalizerState::kDeadReckoning;
  }
  EXPECT_TRUE(alone);
  EXPECT_EQ(update.state, LocalizerState::kLost);
}

TEST_F(LocalizerTest, ScansThatShowTooLittleAloneAreLookedForTogether) {
  LocalizerConfig alone;
  alone.submap.scans = 1;
  Localizer each_alone(alone, *map_);
  LocalizerUpdate update;
  for (int i = 0; i < 24 && update.state != LocalizerState::kTracking; ++i) {
    const TrackedScan scan = Sparse(drive_.Next());
    update = localizer_.Add(scan);
    EXPECT_EQ(each_alone.Add(scan).state, LocalizerState::kLost);
  }
  // What odometry put together is as exact as that.
  EXPECT_EQ(update.state, LocalizerState::kTracking) << update.reason;
  EXPECT_LT((update.T_map_imu.translation() - drive_.T_map_imu().translation()).norm(), 0.05);
  EXPECT_LT(RotationDistance(update.T_map_imu, drive_.T_map_imu()), 1.0 * kRadiansPerDegree);
}

TEST_F(LocalizerTest, EmptyScansAreTotal) {
  TrackedScan empty = drive_.Next();
  empty.points.clear();
  EXPECT_EQ(localizer_.Add(empty).state, LocalizerState::kLost);
  drive_.Pause(1.0);
  const LocalizerUpdate found = localizer_.Add(drive_.Next());
  ExpectAt(found, drive_.T_map_imu());
  TrackedScan later = drive_.Next();
  later.points.clear();
  EXPECT_NE(localizer_.Add(later).state, LocalizerState::kTracking);
}

}  // namespace
}  // namespace hv::relocalize
