#include "hv_relocalize_ndt/place_score.h"

#include <random>

#include <gtest/gtest.h>

#include "known_hall.h"

namespace hv::relocalize {
namespace {

/// A scan in a mapped hall and the judge of its poses.
class PlaceJudgeTest : public testing::Test {
 protected:
  static constexpr double kEdge_m = 0.5;

  std::mt19937 random_{71};
  const loop::Hall hall_{13};
  const NdtLevel map_{kEdge_m, CloudOf(hall_, random_)};
  const Pose truth_ = OnRing(-0.7, 4.4, 2.5, 0.03, 0.02);
  const std::vector<Eigen::Vector3f> scan_ = ScanOf(hall_, truth_, random_);
  const NdtLevel surfaces_{kEdge_m, scan_};
  const PlaceScoreConfig config_;
  const PlaceJudge judge_{config_, map_, surfaces_, scan_,
                          truth_.linear().transpose() * Eigen::Vector3d::UnitZ()};
  const Pose beside_ = truth_ * MakePose(Eigen::Matrix3d::Identity(), {0.6, 0.5, 0.0});
};

TEST_F(PlaceJudgeTest, TheTruePoseFits) {
  const PlaceScore score = judge_.Judge(truth_);
  EXPECT_GT(score.fit, 0.9);
  EXPECT_LE(score.fit, score.overlap);
  EXPECT_GT(score.overlap, 0.95);
  EXPECT_LT(score.seen_through, 0.02);
}

TEST_F(PlaceJudgeTest, OtherPosesFitLess) {
  const PlaceScore score = judge_.Judge(beside_);
  EXPECT_LT(score.fit, 0.6);
  EXPECT_LT(score.score(), 0.6 * judge_.Judge(truth_).score());
  const PlaceScore turned =
      judge_.Judge(truth_ * MakePose(RotationFromRpy(0.0, 0.0, 1.0), {0.0, 0.0, 0.0}));
  EXPECT_LT(turned.fit, 0.6);
  EXPECT_GT(turned.seen_through, 0.02);
  const PlaceScore outside = judge_.Judge(MakePose(truth_.linear(), {500.0, 0.0, 1.0}));
  EXPECT_EQ(outside.fit, 0.0);
  EXPECT_EQ(outside.overlap, 0.0);
}

TEST_F(PlaceJudgeTest, TheLeadOfOneIsTheDeficitOfTheOther) {
  EXPECT_GT(judge_.Lead(truth_, beside_), 5.0);
  EXPECT_EQ(judge_.Lead(truth_, beside_), -judge_.Lead(beside_, truth_));
  EXPECT_EQ(judge_.Lead(truth_, truth_), 0.0);
}

TEST_F(PlaceJudgeTest, AnEmptyScanFitsNowhere) {
  const NdtLevel nothing(kEdge_m, std::vector<Eigen::Vector3f>());
  const std::vector<Eigen::Vector3f> no_points;
  const PlaceJudge judge(config_, map_, nothing, no_points, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(judge.Judge(truth_).score(), 0.0);
  EXPECT_EQ(judge.Lead(truth_, beside_), 0.0);
}

}  // namespace
}  // namespace hv::relocalize
