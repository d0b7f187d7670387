#include "hv_relocalize_ndt/pose_search.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <Eigen/Geometry>

#include "known_hall.h"

namespace hv::relocalize {
namespace {

using Cells = std::vector<StructureCell>;

/// The structure of a hall and of one upright scan in it, whose cells are few enough to be all
/// compared.
class PoseSearchTest : public testing::Test {
 protected:
  PoseSearchTest() {
    std::mt19937 random(41);
    const loop::Hall hall(6);
    surfaces_ = std::make_unique<NdtLevel>(config_.cell_m, CloudOf(hall, random));
    grid_ = std::make_unique<StructureGrid>(*surfaces_, config_.depth);
    truth_ = OnRing(2.1, 4.0, -1.3);
    const NdtLevel scan(config_.cell_m, ScanOf(hall, truth_, random));
    scan_ = StructureCells(scan, Eigen::Matrix3d::Identity());
    config_.max_cells = 4 * static_cast<int>(scan_.size());
    config_.min_score = 0.0;
  }

  PoseWindow Everywhere() const {
    PoseWindow window;
    window.low = grid_->origin();
    window.high = grid_->origin() + grid_->cell_m() * grid_->size().cast<double>();
    window.yaw_range_rad = M_PI;
    return window;
  }
  PoseWindow AtHeading(double yaw_rad) const {
    PoseWindow window = Everywhere();
    window.yaw_rad = yaw_rad;
    window.yaw_range_rad = 0.0;
    return window;
  }
  std::vector<PoseHypothesis> Find(const PoseWindow& window) const {
    return PoseSearch(config_, *grid_).Find(scan_, window);
  }

  /// Share of the scan that the map holds with the sensor in `cell`: what is upright weighs
  /// 1 - level_share, what is level the rest.
  double ScoreAt(const Eigen::Vector3i& cell, double yaw_rad) const {
    const auto yaw = static_cast<float>(yaw_rad);
    const Eigen::AngleAxisf rotation(yaw, Eigen::Vector3f::UnitZ());
    double count[2] = {0.0, 0.0};
    double held[2] = {0.0, 0.0};
    for (const StructureCell& part : scan_) {
      if (part.center.head<2>().norm() > config_.max_range_m) continue;
      const Eigen::Vector3d from_corner =
          (rotation * part.center).cast<double>() + Eigen::Vector3d::Constant(0.5 * config_.cell_m);
      const Eigen::Vector3i offset = (from_corner / config_.cell_m).array().floor().cast<int>();
      const int kind = part.level ? 1 : 0;
      count[kind] += 1.0;
      held[kind] += (grid_->At(0, cell + offset) & part.Fits(yaw)) != 0 ? 1.0 : 0.0;
    }
    return (1.0 - config_.level_share) * held[0] / count[0] +
           config_.level_share * held[1] / count[1];
  }

  /// The best score of all cubes in which a sensor can stand.
  double BestScore(double yaw_rad) const {
    double best = 0.0;
    Eigen::Vector3i cell;
    for (cell.z() = 0; cell.z() < grid_->size().z(); ++cell.z()) {
      for (cell.y() = 0; cell.y() < grid_->size().y(); ++cell.y()) {
        for (cell.x() = 0; cell.x() < grid_->size().x(); ++cell.x()) {
          if (grid_->CanStand(0, cell)) best = std::max(best, ScoreAt(cell, yaw_rad));
        }
      }
    }
    return best;
  }

  PoseSearchConfig config_;
  std::unique_ptr<NdtLevel> surfaces_;
  std::unique_ptr<StructureGrid> grid_;
  Cells scan_;
  Pose truth_;
};

double YawOf(const Pose& pose) { return std::atan2(pose.linear()(1, 0), pose.linear()(0, 0)); }

TEST_F(PoseSearchTest, FindsWhatAnExhaustiveSearchFinds) {
  config_.max_hypotheses = 1;
  for (int i = 0; i < 8; ++i) {
    const double yaw_rad = -3.0 + 0.78 * i;
    const std::vector<PoseHypothesis> found = Find(AtHeading(yaw_rad));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(YawOf(found.front().T_map_level), yaw_rad, 1e-9);
    EXPECT_NEAR(found.front().score, BestScore(yaw_rad), 1e-5);
  }
}

TEST_F(PoseSearchTest, FindsThePlaceOfTheScan) {
  const std::vector<PoseHypothesis> found = Find(Everywhere());
  ASSERT_FALSE(found.empty());
  const Pose& best = found.front().T_map_level;
  EXPECT_LT((best.translation() - truth_.translation()).norm(), 1.8 * config_.cell_m);
  EXPECT_LT(RotationDistance(best, truth_), 5.0 * kRadiansPerDegree);
}

TEST_F(PoseSearchTest, NoPoseScoresBetterThanTheBestHypothesis) {
  const double best = Find(Everywhere()).front().score;
  const Eigen::Vector3i there = grid_->CellOf(truth_.translation());
  std::mt19937 random(42);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  double most = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Array3d anywhere(share(random), share(random), share(random));
    const Eigen::Vector3i cell = (anywhere * grid_->size().cast<double>().array()).cast<int>();
    most = std::max(most, ScoreAt(cell, 2.0 * M_PI * share(random)));
    const Eigen::Vector3i near = there + Eigen::Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 % 3 - 1);
    most = std::max(most, ScoreAt(near, YawOf(truth_) + 0.2 * (2.0 * share(random) - 1.0)));
  }
  EXPECT_GT(most, 0.9 * best);
  // Headings between those of the search may fit a little better.
  EXPECT_LT(most, best + 0.05);
}

TEST_F(PoseSearchTest, ScoresAreThoseOfTheirPoses) {
  for (const PoseHypothesis& hypothesis : Find(Everywhere())) {
    const Pose& pose = hypothesis.T_map_level;
    EXPECT_NEAR(hypothesis.score, ScoreAt(grid_->CellOf(pose.translation()), YawOf(pose)), 1e-5);
  }
}

TEST_F(PoseSearchTest, HypothesesAreDistinctAndBestFirst) {
  config_.min_score_share = 0.3;
  const std::vector<PoseHypothesis> found = Find(Everywhere());
  ASSERT_EQ(found.size(), static_cast<std::size_t>(config_.max_hypotheses));
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_LE(found[i].score, found[i - 1].score);
    EXPECT_GE(found[i].score, config_.min_score_share * found.front().score);
    for (std::size_t k = 0; k < i; ++k) {
      const Pose& a = found[i].T_map_level;
      const Pose& b = found[k].T_map_level;
      EXPECT_TRUE((a.translation() - b.translation()).norm() >= config_.same_place_m ||
                  RotationDistance(a, b) >= config_.same_heading_deg * kRadiansPerDegree);
    }
  }
}

TEST_F(PoseSearchTest, PosesAreAboveFloors) {
  config_.min_score_share = 0.3;
  config_.level_share = 0.0;
  const double best_with_floor = Find(Everywhere()).front().score;
  std::vector<NdtVoxel> half_without_floor;
  for (const NdtVoxel& voxel : surfaces_->voxels()) {
    const bool level = std::abs(voxel.normal.z()) > 0.9F;
    if (!level || voxel.mean.x() > 0.0F) half_without_floor.push_back(voxel);
  }
  const NdtLevel surfaces(config_.cell_m, half_without_floor);
  grid_ = std::make_unique<StructureGrid>(surfaces, config_.depth);
  const std::vector<PoseHypothesis> found = Find(Everywhere());
  ASSERT_FALSE(found.empty());
  // What stands upright still fits best where the scan was taken, but there is no floor any more.
  EXPECT_FALSE(grid_->CanStand(0, grid_->CellOf(truth_.translation())));
  EXPECT_LT(found.front().score, best_with_floor);
  for (const PoseHypothesis& hypothesis : found) {
    EXPECT_TRUE(grid_->CanStand(0, grid_->CellOf(hypothesis.T_map_level.translation())));
  }
}

TEST_F(PoseSearchTest, StaysInItsWindow) {
  config_.min_score_share = 0.3;
  PoseWindow window;
  window.low = {-6.0, -4.0, 0.5};
  window.high = {-1.0, 2.0, 1.5};
  window.yaw_rad = 3.0;
  window.yaw_range_rad = 0.5;
  const std::vector<PoseHypothesis> found = Find(window);
  ASSERT_FALSE(found.empty());
  // Poses are the centres of cubes that the window touches.
  const Eigen::Vector3d half_cube = Eigen::Vector3d::Constant(0.5 * config_.cell_m + 1e-9);
  for (const PoseHypothesis& hypothesis : found) {
    const Eigen::Vector3d place = hypothesis.T_map_level.translation();
    EXPECT_TRUE((place.array() >= (window.low - half_cube).array()).all()) << place.transpose();
    EXPECT_TRUE((place.array() <= (window.high + half_cube).array()).all()) << place.transpose();
    const Pose middle = MakePose(RotationFromRpy(0.0, 0.0, window.yaw_rad), place);
    EXPECT_LE(RotationDistance(hypothesis.T_map_level, middle), window.yaw_range_rad + 1e-6);
  }
  window.low.x() += 1000.0;
  window.high.x() += 1000.0;
  EXPECT_TRUE(Find(window).empty());
}

TEST_F(PoseSearchTest, ResultDoesNotDependOnThreads) {
  config_.min_score_share = 0.3;
  const auto find = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return Find(Everywhere());
  };
  const std::vector<PoseHypothesis> one = find(1);
  const std::vector<PoseHypothesis> two = find(2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].score, two[i].score);
    EXPECT_EQ(one[i].T_map_level.matrix(), two[i].T_map_level.matrix());
  }
}

TEST_F(PoseSearchTest, NothingIsFoundBelowTheLeastScore) {
  const double best = Find(Everywhere()).front().score;
  config_.min_score = best - 0.01;
  ASSERT_FALSE(Find(Everywhere()).empty());
  EXPECT_EQ(Find(Everywhere()).front().score, best);
  config_.min_score = best + 0.01;
  EXPECT_TRUE(Find(Everywhere()).empty());
}

TEST_F(PoseSearchTest, WithoutUprightStructureNothingIsFound) {
  StructureCell floor;
  floor.level = true;
  scan_ = {floor};
  EXPECT_TRUE(Find(Everywhere()).empty());
  scan_.clear();
  EXPECT_TRUE(Find(Everywhere()).empty());
}

}  // namespace
}  // namespace hv::relocalize
