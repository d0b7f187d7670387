#include "hv_relocalize_ndt/global_localizer.h"

#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "known_hall.h"

namespace hv::relocalize {
namespace {

using Points = std::vector<Eigen::Vector3f>;

constexpr unsigned kHall = 7;

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A map of one hall; made once.
class GlobalLocalizerTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::mt19937 random(51);
    map_ =
        std::make_unique<PriorMap>("hall", CloudOf(loop::Hall(kHall), random), RelocalizeConfig());
  }
  static void TearDownTestSuite() { map_.reset(); }

  static LocalizationResult Locate(const LocalizationQuery& query, const PriorMap& map) {
    return GlobalLocalizer(RelocalizeConfig(), map).Locate(query);
  }
  static LocalizationResult Locate(const LocalizationQuery& query) { return Locate(query, *map_); }

  static void ExpectFound(const LocalizationResult& result, const Pose& truth) {
    EXPECT_TRUE(result.localized) << result.reason;
    EXPECT_EQ(result.reason, "");
    EXPECT_LT((result.T_map_scan.translation() - truth.translation()).norm(), 0.03);
    EXPECT_LT(RotationDistance(result.T_map_scan, truth), 0.3 * kRadiansPerDegree);
  }
  static void ExpectRefused(const LocalizationResult& result, const std::string& reason) {
    EXPECT_FALSE(result.localized);
    EXPECT_TRUE(Contains(result.reason, reason)) << result.reason;
  }

  static std::unique_ptr<PriorMap> map_;
};

std::unique_ptr<PriorMap> GlobalLocalizerTest::map_;

class WithoutAGuess : public GlobalLocalizerTest, public testing::WithParamInterface<unsigned> {};

TEST_P(WithoutAGuess, AScanIsLocalized) {
  std::mt19937 random(GetParam());
  const Pose truth = RandomOnRing(random);
  LocalizationQuery query;
  query.points = ScanOf(loop::Hall(kHall), truth, random);
  const LocalizationResult result = Locate(query);
  ExpectFound(result, truth);
  EXPECT_GT(result.score.fit, 0.9);
  EXPECT_GT(result.margin, 0.0);
  const Matrix6d& covariance = result.covariance;
  EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-9 * covariance.norm());
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(covariance);
  EXPECT_GT(solver.eigenvalues()[0], 0.0);
  EXPECT_LT(solver.eigenvalues()[5], 0.1 * 0.1);
}

INSTANTIATE_TEST_SUITE_P(Seeds, WithoutAGuess, testing::Range(100U, 110U));

TEST_F(GlobalLocalizerTest, TheVerticalOfAnImuIsUsed) {
  std::mt19937 random(52);
  const Pose truth = OnRing(-2.0, 4.5, 0.5, 0.6, -0.4);
  LocalizationQuery query;
  query.points = ScanOf(loop::Hall(kHall), truth, random);
  query.up = 9.81 * (truth.linear().transpose() * Eigen::Vector3d::UnitZ());
  ExpectFound(Locate(query), truth);
}

TEST_F(GlobalLocalizerTest, AGuessIsFollowed) {
  std::mt19937 random(53);
  for (int trial = 0; trial < 4; ++trial) {
    const Pose truth = RandomOnRing(random);
    LocalizationQuery query;
    query.points = ScanOf(loop::Hall(kHall), truth, random);
    query.guess = PoseGuess{truth * MakePose(RotationFromRpy(0.05, -0.05, 0.3), {1.0, -1.5, 0.2})};
    ExpectFound(Locate(query), truth);
  }
}

TEST_F(GlobalLocalizerTest, AScanOfAnotherHallIsRefused) {
  for (const unsigned other : {8U, 9U, 10U, 11U}) {
    std::mt19937 random(other);
    LocalizationQuery query;
    query.points = ScanOf(loop::Hall(other), RandomOnRing(random), random);
    LocalizationResult result = Locate(query);
    EXPECT_FALSE(result.localized);
    EXPECT_TRUE(Contains(result.reason, " % of ")) << result.reason;
    query.guess = PoseGuess{OnRing(0.0, 4.0, 1.0)};
    result = Locate(query);
    EXPECT_FALSE(result.localized);
    EXPECT_TRUE(Contains(result.reason, " % of ")) << result.reason;
  }
}

TEST_F(GlobalLocalizerTest, AnEmptyScanIsRefused) {
  LocalizationQuery query;
  ExpectRefused(Locate(query), "no structure");
  query.guess = PoseGuess{OnRing(0.0, 4.0, 1.0)};
  ExpectRefused(Locate(query), "the map knows only 0 %");
}

TEST_F(GlobalLocalizerTest, AnEmptyMapRefusesEverything) {
  std::mt19937 random(54);
  const PriorMap nothing("nothing", {}, RelocalizeConfig());
  LocalizationQuery query;
  query.points = ScanOf(loop::Hall(kHall), RandomOnRing(random), random);
  EXPECT_FALSE(Locate(query, nothing).localized);
  query.guess = PoseGuess{Pose::Identity()};
  ExpectRefused(Locate(query, nothing), "the map knows only 0 %");
}

TEST_F(GlobalLocalizerTest, AScanBesideTheMappedAreaIsRefused) {
  std::mt19937 random(55);
  const loop::Hall hall(kHall);
  Points mapped;
  for (const Eigen::Vector3f& point : CloudOf(hall, random)) {
    if (point.x() < -3.0F) mapped.push_back(point);
  }
  const PriorMap map("one end of the hall", mapped, RelocalizeConfig());
  LocalizationQuery query;
  query.points = ScanOf(hall, OnRing(0.1, 4.8, 2.0), random);
  ExpectRefused(Locate(query, map), "nothing in the map resembles");
  RelocalizeConfig config;
  config.search.min_score = 0.0;
  ExpectRefused(GlobalLocalizer(config, map).Locate(query), "of what the scan sees");
}

TEST_F(GlobalLocalizerTest, TwinHallsAreAmbiguous) {
  std::mt19937 random(56);
  const loop::Hall hall(kHall);
  Points twins = CloudOf(hall, random);
  const std::size_t count = twins.size();
  for (std::size_t i = 0; i < count; ++i) {
    twins.emplace_back(twins[i] + Eigen::Vector3f(40.0F, 0.0F, 0.0F));
  }
  const PriorMap map("twins", twins, RelocalizeConfig());
  const Pose truth = OnRing(1.0, 4.2, -2.0);
  LocalizationQuery query;
  query.points = ScanOf(hall, truth, random);
  const LocalizationResult result = Locate(query, map);
  ExpectRefused(result, "another place fits nearly as well");
  ASSERT_GE(result.candidates.size(), 2U);
  EXPECT_GT(result.candidates[1].score.fit, 0.9);
  // A guess that leaves only one of them in reach settles it.
  query.guess = PoseGuess{truth};
  ExpectFound(Locate(query, map), truth);
}

}  // namespace
}  // namespace hv::relocalize
