#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "hv_relocalize_ndt/ndt_registration.h"
#include "known_hall.h"
#include "surfaces.h"

namespace hv::relocalize {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// A hall as Gaussians at every resolution, and a scan in it.
struct HallAtAllLevels {
  HallAtAllLevels() {
    std::mt19937 random(21);
    const loop::Hall hall(5);
    const Points cloud = CloudOf(hall, random);
    for (const double resolution_m : config.resolutions_m) levels.emplace_back(resolution_m, cloud);
    truth = OnRing(0.9, 4.0, 2.0, 0.02, -0.02);
    scan = ScanOf(hall, truth, random);
  }

  /// From a guess that is off in one of eight directions.
  Pose Align(std::size_t first_level, double offset_m, double offset_deg, int direction) const {
    std::vector<const NdtLevel*> used;
    for (std::size_t i = first_level; i < levels.size(); ++i) used.push_back(&levels[i]);
    const double angle = 0.25 * M_PI * direction;
    const double turn = (direction % 2 == 0 ? 1.0 : -1.0) * offset_deg * kRadiansPerDegree;
    const Pose offset = MakePose(RotationFromRpy(0.0, 0.0, turn),
                                 {offset_m * std::cos(angle), offset_m * std::sin(angle), 0.0});
    const NdtSource source(config, scan);
    return NdtRegistration(config).Align(used, source, truth * offset).T_target_source;
  }

  /// Of the eight directions, those from which the pose is found to 2 cm and 0.2 deg.
  int Found(std::size_t first_level, double offset_m, double offset_deg) const {
    int found = 0;
    for (int direction = 0; direction < 8; ++direction) {
      const Pose pose = Align(first_level, offset_m, offset_deg, direction);
      const double error_m = (pose.translation() - truth.translation()).norm();
      found += error_m < 0.02 && RotationDistance(pose, truth) < 0.2 * kRadiansPerDegree ? 1 : 0;
    }
    return found;
  }

  NdtConfig config;
  std::vector<NdtLevel> levels;
  Points scan;
  Pose truth;
};

/// How far a guess is off [m, deg].
class Basin : public testing::TestWithParam<std::pair<double, double>> {
 protected:
  static void SetUpTestSuite() { hall_ = std::make_unique<HallAtAllLevels>(); }
  static void TearDownTestSuite() { hall_.reset(); }
  static std::unique_ptr<HallAtAllLevels> hall_;
};

std::unique_ptr<HallAtAllLevels> Basin::hall_;

TEST_P(Basin, CoarseToFineFindsThePose) {
  const auto [offset_m, offset_deg] = GetParam();
  EXPECT_EQ(hall_->Found(0, offset_m, offset_deg), 8);
}

INSTANTIATE_TEST_SUITE_P(Offsets, Basin,
                         testing::Values(std::pair(0.5, 3.0), std::pair(1.0, 5.0),
                                         std::pair(2.0, 10.0), std::pair(3.0, 15.0)));

TEST(AlignmentTest, EveryCoarserLevelWidensTheBasin) {
  const HallAtAllLevels hall;
  EXPECT_EQ(hall.Found(3, 0.5, 3.0), 8);
  EXPECT_EQ(hall.Found(3, 1.0, 5.0), 0);
  EXPECT_EQ(hall.Found(2, 1.0, 5.0), 8);
  EXPECT_LT(hall.Found(2, 3.0, 15.0), 6);
  EXPECT_EQ(hall.Found(1, 3.0, 15.0), 8);
  EXPECT_EQ(hall.Found(3, 3.0, 15.0), 0);
  int with_all = 0;
  int without_coarsest = 0;
  for (const double offset_m : {4.0, 5.0, 6.0}) {
    with_all += hall.Found(0, offset_m, 5.0 * offset_m);
    without_coarsest += hall.Found(1, offset_m, 5.0 * offset_m);
  }
  EXPECT_GT(with_all, without_coarsest);
}

/// Aligns with the levels of these resolutions.
NdtResult AlignTo(const Points& map, const Points& scan, const Pose& guess,
                  const std::vector<double>& resolutions_m = NdtConfig().resolutions_m) {
  const NdtConfig config;
  std::vector<NdtLevel> levels;
  for (const double resolution_m : resolutions_m) levels.emplace_back(resolution_m, map);
  std::vector<const NdtLevel*> used;
  for (const NdtLevel& level : levels) used.push_back(&level);
  return NdtRegistration(config).Align(used, NdtSource(config, scan), guess);
}

Points Floor(float half_m, float z, std::mt19937& random) {
  Points points;
  AddFace({-half_m, -half_m, z}, 2.0F * half_m * Eigen::Vector3f::UnitX(),
          2.0F * half_m * Eigen::Vector3f::UnitY(), static_cast<int>(200.0F * half_m * half_m),
          0.01F, random, points);
  return points;
}

double YawBetween(const Pose& a, const Pose& b) {
  const Eigen::Matrix3d turn = a.linear().transpose() * b.linear();
  return std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1));
}

/// Levels that are used, and how far these may shift and turn a scan on a floor.
struct FloorLimits {
  std::vector<double> resolutions_m;
  double shift_m;
  double yaw_deg;
};

class OnAFloor : public testing::TestWithParam<FloorLimits> {};

TEST_P(OnAFloor, HeightAndTiltAreFound) {
  // Cubes of Gaussians draw a patch of floor to where it lies evenly on them: coarse ones far.
  std::mt19937 random(22);
  const Points map = Floor(25.0F, 0.0F, random);
  const Points scan = Floor(8.0F, -1.0F, random);
  for (int i = 0; i < 8; ++i) {
    const double a = 0.8 * i;
    const Pose guess = MakePose(RotationFromRpy(0.04 * std::cos(a), 0.04 * std::sin(a), a),
                                {2.0 * std::cos(a), 2.0 * std::sin(a), 1.25});
    const Pose pose = AlignTo(map, scan, guess, GetParam().resolutions_m).T_target_source;
    EXPECT_NEAR(pose.translation().z(), 1.0, 0.005);
    EXPECT_LT(std::acos(pose.linear()(2, 2)), 0.05 * kRadiansPerDegree);
    const Eigen::Vector3d shift = pose.translation() - guess.translation();
    EXPECT_LT(shift.head<2>().norm(), GetParam().shift_m);
    EXPECT_LT(std::abs(YawBetween(guess, pose)), GetParam().yaw_deg * kRadiansPerDegree);
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, OnAFloor,
                         testing::Values(FloorLimits{{1.0}, 0.1, 0.5},
                                         FloorLimits{{10.0, 5.0, 3.0, 1.0}, 2.5, 45.0}));

TEST_P(OnAFloor, NothingIsHeldAlongIt) {
  std::mt19937 random(26);
  const Points map = Floor(25.0F, 0.0F, random);
  const Points scan = Floor(8.0F, -1.0F, random);
  const Pose guess = MakePose(Eigen::Matrix3d::Identity(), {0.3, 0.2, 1.0});
  const NdtResult result = AlignTo(map, scan, guess, GetParam().resolutions_m);
  const Matrix6d covariance = CovarianceOf(result, 1.0);
  EXPECT_GT(covariance(0, 0), 1.0);
  EXPECT_GT(covariance(1, 1), 1.0);
  EXPECT_GT(covariance(5, 5), 0.1);
  // Height and tilt are held; in the covariance itself that hides behind what is free.
  const Matrix6d information = covariance.inverse();
  EXPECT_GT(information(2, 2), 1e5);
  EXPECT_GT(information(3, 3), 1e5);
  EXPECT_GT(information(4, 4), 1e5);
}

/// A corridor of 3 m along the x axis with a floor.
Points Corridor(float half_m, float floor_m, std::mt19937& random) {
  Points points;
  const Eigen::Vector3f along = 2.0F * half_m * Eigen::Vector3f::UnitX();
  const auto count = static_cast<int>(800.0F * half_m);
  const Eigen::Vector3f right(-half_m, -1.5F, floor_m);
  const Eigen::Vector3f left(-half_m, 1.5F, floor_m);
  AddFace(right, along, 3.0F * Eigen::Vector3f::UnitY(), count, 0.01F, random, points);
  AddFace(right, along, 3.0F * Eigen::Vector3f::UnitZ(), count, 0.01F, random, points);
  AddFace(left, along, 3.0F * Eigen::Vector3f::UnitZ(), count, 0.01F, random, points);
  return points;
}

class InACorridor : public testing::TestWithParam<double> {};

TEST_P(InACorridor, AScanSlidesByLessThanASeventhOfAVoxel) {
  const double resolution_m = GetParam();
  std::mt19937 random(23);
  const Points map = Corridor(40.0F, 0.0F, random);
  const Points scan = Corridor(15.0F, -1.0F, random);
  for (int i = 0; i < 16; ++i) {
    const Pose guess =
        MakePose(RotationFromRpy(0.02, -0.02, 0.04), {resolution_m * i / 16.0, 0.3, 1.1});
    const Pose pose = AlignTo(map, scan, guess, {resolution_m}).T_target_source;
    EXPECT_NEAR(pose.translation().y(), 0.0, 0.005);
    EXPECT_LT(RotationDistance(pose, Pose::Identity()), 0.15 * kRadiansPerDegree);
    const double slide_m = pose.translation().x() - guess.translation().x();
    EXPECT_LT(std::abs(slide_m), resolution_m / 7.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, InACorridor, testing::Values(10.0, 5.0, 3.0, 1.0));

TEST_P(InACorridor, LittleIsHeldAlongIt) {
  // Turned against the axes, so that its walls cut corners of the cubes.
  std::mt19937 random(27);
  const Eigen::Isometry3f turn(Eigen::AngleAxisf(0.4F, Eigen::Vector3f::UnitZ()));
  Points map = Corridor(40.0F, 0.0F, random);
  for (Eigen::Vector3f& point : map) point = turn * point;
  const Points scan = Corridor(15.0F, -1.0F, random);
  Pose guess(turn.cast<double>());
  guess.translation().z() = 1.0;
  const NdtResult result = AlignTo(map, scan, guess, {GetParam()});
  const Matrix6d covariance = CovarianceOf(result, 1.0);
  EXPECT_GT(covariance(0, 0), 50.0 * 50.0 * covariance(1, 1));
  EXPECT_GT(covariance(0, 0), 50.0 * 50.0 * covariance(2, 2));
}

TEST(AlignmentTest, EmptyCloudsLeaveTheGuess) {
  std::mt19937 random(24);
  const Points floor = Floor(5.0F, 0.0F, random);
  const Pose guess = OnRing(0.3, 2.0, 1.0, 0.1, -0.1);
  for (const NdtResult& result :
       {AlignTo({}, floor, guess), AlignTo(floor, {}, guess), AlignTo({}, {}, guess),
        AlignTo(floor, {{0.0F, 0.0F, 500.0F}}, guess)}) {
    EXPECT_LT((result.T_target_source.matrix() - guess.matrix()).norm(), 1e-12);
    EXPECT_EQ(result.cost_per_point, 0.0);
    EXPECT_TRUE(result.information.isZero());
  }
  const NdtConfig config;
  const NdtResult no_levels = NdtRegistration(config).Align({}, NdtSource(config, floor), guess);
  EXPECT_EQ(no_levels.T_target_source.matrix(), guess.matrix());
}

TEST(AlignmentTest, AFewPointsComeToLieOnTheFloor) {
  std::mt19937 random(25);
  const Points floor = Floor(5.0F, 0.0F, random);
  const Pose guess = MakePose(RotationFromRpy(0.0, 0.0, 0.4), {0.3, 0.2, 1.2});
  const Eigen::Vector3f below(0.0F, 0.0F, -1.0F);
  const Eigen::Vector3f ahead(1.0F, 0.3F, -1.0F);
  for (const Points& scan :
       {Points{below}, Points{below, ahead}, Points(7, below), Points{Eigen::Vector3f::Zero()}}) {
    const NdtResult result = AlignTo(floor, scan, guess);
    EXPECT_TRUE(result.T_target_source.matrix().allFinite());
    EXPECT_TRUE(result.information.allFinite());
    EXPECT_TRUE(result.T_target_source.linear().isUnitary(1e-9));
    for (const Eigen::Vector3f& point : scan) {
      EXPECT_NEAR((result.T_target_source * point.cast<double>()).z(), 0.0, 0.01);
    }
  }
}

}  // namespace
}  // namespace hv::relocalize
