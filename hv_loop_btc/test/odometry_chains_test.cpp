#include "odometry_chains.h"

#include <gtest/gtest.h>

#include "graph_solver.h"
#include "graph_world.h"
#include "skeleton.h"

namespace hv::loop {
namespace {

Measurement Indexed(const GraphEdge& edge) {
  return {edge.from, edge.to, edge.T_from_to, edge.information};
}

std::vector<Measurement> Odometry(const GraphWorld& world) {
  std::vector<Measurement> odometry;
  for (const GraphEdge& edge : world.odometry()) odometry.push_back(Indexed(edge));
  return odometry;
}

GraphWorld SmallCity() { return GraphWorld(CityDrive(200, 10, 3, 1), WorldNoise(), 2); }

TEST(OdometryChains, ComposesEdgesWithCovarianceInBothDirections) {
  const std::vector<Measurement> odometry = Odometry(SmallCity());
  const OdometryChains chains(200, odometry);
  UncertainPose composed;
  for (std::size_t i = 40; i < 90; ++i) {
    composed = composed * UncertainPose{odometry[i].T_from_to, InverseOf(odometry[i].information)};
  }
  const UncertainPose between = chains.Between(40, 90);
  EXPECT_LT((between.T_a_b.matrix() - composed.T_a_b.matrix()).norm(), 1e-10);
  EXPECT_LT((between.covariance - composed.covariance).norm(), 1e-9 * composed.covariance.norm());
  const UncertainPose back = chains.Between(90, 40);
  const UncertainPose inverse = Inverse(composed);
  EXPECT_LT((back.T_a_b.matrix() - inverse.T_a_b.matrix()).norm(), 1e-10);
  EXPECT_LT((back.covariance - inverse.covariance).norm(), 1e-9 * inverse.covariance.norm());
}

TEST(OdometryChains, CovarianceIsThatOfManyRuns) {
  Matrix6d sum = Matrix6d::Zero();
  const std::vector<Pose> truth = CityDrive(60, 10, 3, 1);
  const Pose T_a_b = truth[5].inverse() * truth[55];
  constexpr unsigned kRuns = 2000;
  Matrix6d predicted;
  for (unsigned run = 0; run < kRuns; ++run) {
    const UncertainPose between =
        OdometryChains(60, Odometry(GraphWorld(truth, WorldNoise(), run))).Between(5, 55);
    const Vector6d error = se3::Log(between.T_a_b.inverse() * T_a_b);
    sum += error * error.transpose() / kRuns;
    predicted = between.covariance;
  }
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(sum(k, k) / predicted(k, k), 1.0, 0.15) << k;
}

TEST(OdometryChains, KeepsSegmentsApart) {
  std::vector<Measurement> odometry = Odometry(SmallCity());
  odometry.erase(odometry.begin() + 99);  // 99 -> 100
  const OdometryChains chains(200, odometry);
  EXPECT_TRUE(chains.SameChain(0, 99));
  EXPECT_FALSE(chains.SameChain(99, 100));
  EXPECT_EQ(chains.First(150), 100U);
}

TEST(Skeleton, KeepsTouchedVerticesAndStartsOfChains) {
  GraphWorld world = SmallCity();
  std::vector<Measurement> odometry = Odometry(world);
  odometry.erase(odometry.begin() + 99);
  const OdometryChains chains(200, odometry);
  const Skeleton skeleton(chains, {Indexed(world.TrueLoop(20, 130))});
  EXPECT_EQ(skeleton.vertices(), (std::vector<std::size_t>{0, 20, 100, 130}));
  ASSERT_EQ(skeleton.odometry().size(), 2U);
  EXPECT_EQ(skeleton.odometry()[1].from, 2U);
  EXPECT_EQ(skeleton.odometry()[1].to, 3U);
  ASSERT_EQ(skeleton.loops().size(), 1U);
  EXPECT_EQ(skeleton.loops()[0].from, 1U);
  EXPECT_EQ(skeleton.loops()[0].to, 3U);
}

TEST(Skeleton, HasTheSolutionOfTheWholeGraph) {
  GraphWorld world = SmallCity();
  const std::vector<Measurement> odometry = Odometry(world);
  const OdometryChains chains(200, odometry);
  const std::vector<Measurement> loops = {Indexed(world.TrueLoop(0, 120)),
                                          Indexed(world.TrueLoop(50, 180))};
  std::vector<Pose> poses = {world.truth()[0]};
  for (const Measurement& edge : odometry) poses.push_back(poses.back() * edge.T_from_to);

  GraphSolver whole(poses);
  for (const Measurement& edge : odometry) whole.AddConstraint(edge);
  for (const Measurement& loop : loops) whole.AddConstraint(loop);
  whole.Solve(20, 1e-10);

  const Skeleton skeleton(chains, loops);
  std::vector<Pose> kept;
  for (const std::size_t vertex : skeleton.vertices()) kept.push_back(poses[vertex]);
  GraphSolver small(kept);
  for (const Measurement& edge : skeleton.odometry()) small.AddConstraint(edge);
  for (const Measurement& loop : skeleton.loops()) small.AddConstraint(loop);
  small.Solve(20, 1e-10);
  skeleton.Spread(small.Poses(), poses);

  double between = 0.0;
  for (const std::size_t i : skeleton.vertices()) {
    EXPECT_LT((whole.Poses()[i].translation() - poses[i].translation()).norm(), 5e-3) << i;
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    between = std::max(between, (whole.Poses()[i].translation() - poses[i].translation()).norm());
  }
  EXPECT_LT(between, 0.1);  // spreading evenly is only a start for the whole solve
}

}  // namespace
}  // namespace hv::loop
