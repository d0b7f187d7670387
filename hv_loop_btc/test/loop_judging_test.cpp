#include <string>

#include <gtest/gtest.h>

#include "hv_loop_btc/pose_graph.h"
#include "world_graph.h"

namespace hv::loop {
namespace {

constexpr std::size_t kTrueLoops = 40;

enum class FalseLoops { kRandom30, kRandom50, kShiftedGroups, kAliasedGroups, kAll };

struct Scenario {
  std::string name;
  FalseLoops kind;
  double yaw_bias;  // [rad] a keyframe, unknown to the odometry edges
  bool gated;       // whether odometry alone may refuse loops
};

std::vector<GraphEdge> MakeFalseLoops(FalseLoops kind, GraphWorld& world) {
  std::vector<GraphEdge> loops;
  const bool all = kind == FalseLoops::kAll;
  if (kind == FalseLoops::kRandom30 || all) Append(world.RandomFalseLoops(17), loops);
  if (kind == FalseLoops::kRandom50) Append(world.RandomFalseLoops(40), loops);
  for (const std::size_t size : {2, 3, 5}) {
    if (kind == FalseLoops::kShiftedGroups || all) Append(world.ShiftedGroup(size, 8.0), loops);
    if (kind == FalseLoops::kAliasedGroups || all) Append(world.AliasedGroup(size), loops);
  }
  return loops;
}

class FalseLoopsTest : public testing::TestWithParam<Scenario> {
 protected:
  GraphWorld MakeWorld(unsigned seed) const {
    WorldNoise noise;
    noise.yaw_bias = GetParam().yaw_bias;
    return GraphWorld(CityDrive(1000, 25, 4, seed), noise, seed + 100);
  }

  PoseGraphConfig Config() const {
    PoseGraphConfig config;
    if (!GetParam().gated) config.odometry_gate_scale = 1e6;
    return config;
  }
};

TEST_P(FalseLoopsTest, AreRefusedAndTheMapStaysAsGoodAsWithoutThem) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    GraphWorld world = MakeWorld(seed);
    std::vector<GraphEdge> loops = world.TrueLoops(kTrueLoops);
    ASSERT_EQ(loops.size(), kTrueLoops);
    PoseGraph clean = BuildGraph(world, loops, Config());
    EXPECT_EQ(clean.Optimize().loops_refused, 0U);

    Append(MakeFalseLoops(GetParam().kind, world), loops);
    PoseGraph graph = BuildGraph(world, loops, Config());
    const PoseGraphSummary summary = graph.Optimize();
    EXPECT_TRUE(summary.converged) << summary.reason;
    const AcceptedLoops accepted = CountAccepted(graph, kTrueLoops);
    EXPECT_EQ(accepted.good, kTrueLoops) << "seed " << seed;
    EXPECT_EQ(accepted.bad, 0U) << "seed " << seed;
    EXPECT_LT(world.RmsError(graph.Poses()), 2.0 * world.RmsError(clean.Poses()));
  }
}

TEST_P(FalseLoopsTest, AreRefusedAsTheyArrive) {
  GraphWorld world = MakeWorld(5);
  std::vector<GraphEdge> loops = world.TrueLoops(kTrueLoops);
  PoseGraph clean = BuildGraph(world, loops, Config());
  clean.Optimize();
  Append(MakeFalseLoops(GetParam().kind, world), loops);
  PoseGraph graph(Config());
  graph.AddVertex(0, Time(), world.truth()[0]);
  for (const GraphEdge& edge : world.odometry()) {
    graph.AddVertex(edge.to, Time(), Pose::Identity());
    graph.AddEdge(edge);
    for (const GraphEdge& loop : loops) {
      if (loop.to == edge.to) graph.AddEdge(loop);
    }
    if (edge.to % 20 == 0) graph.Optimize();
  }
  const PoseGraphSummary summary = graph.Optimize();
  EXPECT_EQ(summary.loops_accepted, kTrueLoops);
  EXPECT_LT(world.RmsError(graph.Poses()), 2.0 * world.RmsError(clean.Poses()));
}

INSTANTIATE_TEST_SUITE_P(
    PoseGraph, FalseLoopsTest,
    testing::Values(Scenario{"Random30", FalseLoops::kRandom30, 0.0, true},
                    Scenario{"Random30Drift", FalseLoops::kRandom30, 5e-5, true},
                    Scenario{"Random30Ungated", FalseLoops::kRandom30, 0.0, false},
                    Scenario{"Random50Ungated", FalseLoops::kRandom50, 5e-5, false},
                    Scenario{"ShiftedGroups", FalseLoops::kShiftedGroups, 0.0, true},
                    Scenario{"ShiftedGroupsUngated", FalseLoops::kShiftedGroups, 5e-5, false},
                    Scenario{"AliasedGroupsUngated", FalseLoops::kAliasedGroups, 5e-5, false},
                    Scenario{"All", FalseLoops::kAll, 5e-5, true},
                    Scenario{"AllUngated", FalseLoops::kAll, 5e-5, false}),
    [](const testing::TestParamInfo<Scenario>& scenario) { return scenario.param.name; });

GraphWorld MakeWorld() { return GraphWorld(CityDrive(600, 20, 3, 1), WorldNoise(), 2); }

TEST(LoopJudging, ATrueLoopIsAddedWithoutJudgingAllAnew) {
  GraphWorld world = MakeWorld();
  std::vector<GraphEdge> loops = world.TrueLoops(30);
  const GraphEdge last = loops.back();
  loops.pop_back();
  PoseGraph graph = BuildGraph(world, loops);
  graph.Optimize();
  graph.AddEdge(last);
  const PoseGraphSummary summary = graph.Optimize();
  EXPECT_FALSE(summary.judged_all_loops);
  EXPECT_EQ(summary.loops_accepted, 30U);
}

TEST(LoopJudging, AFalseLoopWithoutAnyOtherIsRefused) {
  GraphWorld world = MakeWorld();
  PoseGraph graph = BuildGraph(world, world.ShiftedGroup(1, 8.0));
  const double before = world.RmsError(graph.Poses());
  EXPECT_EQ(graph.Optimize().loops_refused, 1U);
  EXPECT_NEAR(world.RmsError(graph.Poses()), before, 1e-9);
}

TEST(LoopJudging, LoopsRefusedAtFirstAreAcceptedOnceOthersAgree) {
  WorldNoise noise;
  noise.yaw_bias = 2e-4;  // far more than the odometry edges admit
  GraphWorld world(CityDrive(600, 20, 3, 1), noise, 2);
  PoseGraphConfig config;
  config.odometry_gate_scale = 100.0;
  PoseGraph graph = BuildGraph(world, {}, config);
  const std::vector<GraphEdge> loops = world.TrueLoops(60);
  graph.AddEdge(loops[40]);
  EXPECT_EQ(graph.Optimize().loops_accepted, 0U);
  for (const GraphEdge& loop : loops) graph.AddEdge(loop);
  EXPECT_EQ(graph.Optimize().loops_refused, 0U);
}

class SegmentsTest : public testing::Test {
 protected:
  static constexpr std::uint32_t kStart = 300;

  /// Largest error [m] of positions of the second segment.
  double SecondSegmentError(const PoseGraph& graph) const {
    double largest = 0.0;
    for (std::uint32_t i = kStart; i < world_.truth().size(); ++i) {
      const Eigen::Vector3d truth = world_.truth()[i].translation();
      largest = std::max(largest, (graph.pose(i).translation() - truth).norm());
    }
    return largest;
  }

  /// True loops between both segments.
  std::vector<GraphEdge> Joining(std::size_t count) {
    std::vector<GraphEdge> loops;
    for (const auto& [i, j] : world_.Revisits(3.0)) {
      if (i < kStart && j >= kStart) loops.push_back(world_.TrueLoop(i, j));
    }
    EXPECT_GE(loops.size(), count);
    std::vector<GraphEdge> chosen;
    for (std::size_t k = 0; k < count; ++k) chosen.push_back(loops[k * loops.size() / count]);
    return chosen;
  }

  GraphEdge FalseJoin() {
    return world_.Loop(50, 500, MakePose(RotationFromRpy(0, 0, 1), {9, 9, 0}));
  }

  GraphWorld world_ = MakeWorld();
};

TEST_F(SegmentsTest, StayApartWithoutLoops) {
  PoseGraph graph = BuildGraph(world_, {}, PoseGraphConfig(), {kStart});
  EXPECT_TRUE(graph.Optimize().converged);
  EXPECT_LT((graph.pose(kStart).matrix() - Pose::Identity().matrix()).norm(), 1e-12);
  EXPECT_LT((graph.pose(0).matrix() - world_.truth()[0].matrix()).norm(), 1e-12);
}

TEST_F(SegmentsTest, AreJoinedByLoopsThatAgree) {
  PoseGraph graph = BuildGraph(world_, Joining(20), PoseGraphConfig(), {kStart});
  EXPECT_EQ(graph.Optimize().loops_accepted, 20U);
  EXPECT_LT(SecondSegmentError(graph), 1.0);
  EXPECT_LT((graph.pose(0).matrix() - world_.truth()[0].matrix()).norm(), 1e-12);
}

TEST_F(SegmentsTest, OneLoopDoesNotJoinAndASecondThatAgreesDoes) {
  const std::vector<GraphEdge> loops = Joining(2);
  PoseGraph graph = BuildGraph(world_, {loops[0]}, PoseGraphConfig(), {kStart});
  EXPECT_EQ(graph.Optimize().loops_accepted, 0U);
  EXPECT_LT((graph.pose(kStart).matrix() - Pose::Identity().matrix()).norm(), 1e-12);
  graph.AddEdge(loops[1]);
  EXPECT_EQ(graph.Optimize().loops_accepted, 2U);
  EXPECT_LT(SecondSegmentError(graph), 2.0);
}

TEST_F(SegmentsTest, FalseLoopsBetweenThemAreRefused) {
  std::vector<GraphEdge> loops = Joining(10);
  for (int k = 0; k < 3; ++k) loops.push_back(FalseJoin());
  PoseGraph graph = BuildGraph(world_, loops, PoseGraphConfig(), {kStart});
  graph.Optimize();
  const AcceptedLoops accepted = CountAccepted(graph, 10);
  EXPECT_EQ(accepted.good, 10U);
  EXPECT_EQ(accepted.bad, 0U);
  EXPECT_LT(SecondSegmentError(graph), 1.0);
}

TEST_F(SegmentsTest, LoopsInTheReverseDirectionJoinToo) {
  std::vector<GraphEdge> loops = Joining(10);
  for (GraphEdge& loop : loops) {
    std::swap(loop.from, loop.to);
    loop.T_from_to = loop.T_from_to.inverse();
  }
  PoseGraph graph = BuildGraph(world_, loops, PoseGraphConfig(), {kStart});
  EXPECT_EQ(graph.Optimize().loops_accepted, 10U);
  EXPECT_LT(SecondSegmentError(graph), 1.0);
}

}  // namespace
}  // namespace hv::loop
