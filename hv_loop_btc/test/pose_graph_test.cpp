#include "hv_loop_btc/pose_graph.h"

#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "world_graph.h"

namespace hv::loop {
namespace {

GraphWorld SmallWorld(const WorldNoise& noise = WorldNoise()) {
  return GraphWorld(CityDrive(600, 20, 3, 1), noise, 2);
}

/// A way round a figure eight of two circles of 20 m, driven twice.
std::vector<Pose> FigureEight() {
  std::vector<Pose> truth;
  for (int i = 0; i < 400; ++i) {
    const double angle = 4.0 * M_PI * i / 200.0;
    const double side =
        angle < 2.0 * M_PI || (angle > 4.0 * M_PI && angle < 6.0 * M_PI) ? 1.0 : -1.0;
    const Eigen::Vector3d position(20.0 * std::sin(angle), side * 20.0 * (1.0 - std::cos(angle)),
                                   0.5 * std::sin(0.5 * angle));
    truth.push_back(MakePose(RotationFromRpy(0.0, 0.0, side * angle), position));
  }
  return truth;
}

std::string MessageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PoseGraph, ExactLoopsUndoTheErrorOfAnUncertainEdge) {
  WorldNoise none;
  none.odometry_translation = none.odometry_rotation = 0.0;
  none.loop_translation = none.loop_rotation = 0.0;
  GraphWorld world(FigureEight(), none, 1);
  PoseGraph graph;
  Pose guess = world.truth()[0];
  graph.AddVertex(0, Time(), guess);
  for (GraphEdge edge : world.odometry()) {
    edge.information = DiagonalInformation(0.01, 3e-4);
    if (edge.to == 250) {
      edge.T_from_to.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()));
      edge.information = DiagonalInformation(0.5, 0.5);
    }
    guess = guess * edge.T_from_to;
    graph.AddVertex(edge.to, Time(), guess);
    graph.AddEdge(edge);
  }
  EXPECT_GT(world.RmsError(graph.Poses()), 4.0);
  for (std::uint32_t i = 0; i < 200; i += 5) {
    GraphEdge loop = world.TrueLoop(i, i + 200);
    loop.information = DiagonalInformation(0.05, 0.005);
    graph.AddEdge(loop);
  }
  const PoseGraphSummary summary = graph.Optimize();
  EXPECT_TRUE(summary.converged);
  EXPECT_EQ(summary.loops_accepted, 40U);
  EXPECT_LT(world.RmsError(graph.Poses()), 0.05);
}

TEST(PoseGraph, LoopsReduceDriftOfAFigureEight) {
  WorldNoise noise;
  noise.yaw_bias = 2e-4;
  GraphWorld world(FigureEight(), noise, 1);
  PoseGraph graph = BuildGraph(world, {});
  const double before = world.RmsError(graph.Poses());
  for (std::uint32_t i = 0; i < 200; i += 10) graph.AddEdge(world.TrueLoop(i, i + 200));
  const PoseGraphSummary summary = graph.Optimize();
  EXPECT_TRUE(summary.converged) << summary.reason;
  EXPECT_LT(summary.final_cost, summary.initial_cost + 1e-9);
  EXPECT_LT(world.RmsError(graph.Poses()), 0.7 * before);
}

TEST(PoseGraph, TheFirstKeyframeIsHeld) {
  GraphWorld world = SmallWorld();
  PoseGraph graph = BuildGraph(world, world.TrueLoops(20));
  graph.Optimize();
  EXPECT_LT((graph.pose(0).matrix() - world.truth()[0].matrix()).norm(), 1e-12);
}

TEST(PoseGraph, IdsNeedNotStartAtZeroNorBeContiguous) {
  PoseGraph graph;
  GraphEdge edge;
  edge.from = 7;
  edge.to = 12;
  edge.T_from_to = MakePose(RotationFromRpy(0.0, 0.0, 0.5), {1.0, 2.0, 3.0});
  graph.AddVertex(7, Time(), Pose::Identity());
  graph.AddVertex(12, Time(), Pose::Identity());
  graph.AddEdge(edge);
  EXPECT_TRUE(graph.Optimize().converged);
  EXPECT_LT((graph.pose(12).matrix() - edge.T_from_to.matrix()).norm(), 1e-12);
}

TEST(PoseGraph, NothingToDoIsNoProblem) {
  PoseGraph graph;
  EXPECT_TRUE(graph.Optimize().converged);
  graph.AddVertex(3, Time(), Pose::Identity());
  EXPECT_TRUE(graph.Optimize().converged);
  EXPECT_EQ(graph.size(), 1U);
}

TEST(PoseGraph, TiltKeepsTheMapLevel) {
  WorldNoise noise;
  noise.odometry_rotation = 2e-3;
  const GraphWorld world = SmallWorld(noise);
  PoseGraph free = BuildGraph(world, {});
  PoseGraph level = BuildGraph(world, {});
  for (const GraphVertex& vertex : level.Poses()) {
    level.AddTilt(vertex.id, world.truth()[vertex.id].linear().transpose().col(2));
  }
  free.Optimize();
  EXPECT_TRUE(level.Optimize().converged);
  const auto mean_tilt = [&](const PoseGraph& graph) {
    double sum = 0.0;
    for (const GraphVertex& vertex : graph.Poses()) {
      const Eigen::Vector3d up = world.truth()[vertex.id].linear().transpose().col(2);
      sum += (vertex.T_map_imu.linear() * up).head<2>().norm();
    }
    return sum / static_cast<double>(graph.size());
  };
  EXPECT_LT(mean_tilt(level), 0.3 * mean_tilt(free));
  EXPECT_LT(mean_tilt(level), 0.005);
}

TEST(PoseGraph, SavedAndReadAgainItIsTheSame) {
  GraphWorld world = SmallWorld();
  std::vector<GraphEdge> loops = world.TrueLoops(20);
  Append(world.RandomFalseLoops(5), loops);
  PoseGraph graph = BuildGraph(world, loops);
  graph.Optimize();
  const PoseGraphData data = graph.ToData();
  PoseGraph read = PoseGraph::FromData(data);
  ASSERT_EQ(read.size(), graph.size());
  ASSERT_EQ(read.edges().size(), graph.edges().size());
  for (std::size_t k = 0; k < data.edges.size(); ++k) {
    EXPECT_EQ(read.edges()[k].accepted, graph.edges()[k].accepted);
    EXPECT_EQ(read.edges()[k].kind, graph.edges()[k].kind);
  }
  const PoseGraphSummary summary = read.Optimize();
  EXPECT_FALSE(summary.judged_all_loops);
  EXPECT_EQ(summary.loops_accepted, 20U);
  for (const GraphVertex& vertex : data.vertices) {
    EXPECT_LT((read.pose(vertex.id).matrix() - vertex.T_map_imu.matrix()).norm(), 1e-2);
    EXPECT_EQ(read.Poses()[vertex.id].stamp, vertex.stamp);
  }
}

TEST(PoseGraph, IsDeterministic) {
  GraphWorld world = SmallWorld();
  std::vector<GraphEdge> loops = world.TrueLoops(20);
  Append(world.RandomFalseLoops(10), loops);
  PoseGraph a = BuildGraph(world, loops);
  PoseGraph b = BuildGraph(world, loops);
  a.Optimize();
  b.Optimize();
  for (std::uint32_t i = 0; i < 600; ++i) EXPECT_EQ(a.pose(i).matrix(), b.pose(i).matrix());
}

TEST(PoseGraph, WrongVerticesAreNamed) {
  PoseGraph graph;
  graph.AddVertex(5, Time(), Pose::Identity());
  EXPECT_EQ(MessageOf([&] { graph.AddVertex(5, Time(), Pose::Identity()); }),
            "pose graph: keyframe 5: ids must grow");
  Pose broken = Pose::Identity();
  broken.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(MessageOf([&] { graph.AddVertex(6, Time(), broken); }),
            "pose graph: keyframe 6: its pose is not a finite rigid transform");
  EXPECT_EQ(MessageOf([&] { graph.pose(9); }),
            "pose graph: pose of keyframe 9: keyframe 9 is unknown");
  EXPECT_EQ(MessageOf([&] { graph.AddTilt(5, Eigen::Vector3d::Zero()); }),
            "pose graph: tilt of keyframe 5: has no direction");
  EXPECT_EQ(graph.size(), 1U);
}

TEST(PoseGraph, WrongEdgesAreNamedAndNotAdded) {
  PoseGraph graph;
  for (std::uint32_t id = 0; id < 4; ++id) graph.AddVertex(id, Time(), Pose::Identity());
  const auto message = [&](const std::function<void(GraphEdge&)>& spoil) {
    GraphEdge edge;
    edge.kind = EdgeKind::kLoop;
    edge.to = 2;
    spoil(edge);
    return MessageOf([&] { graph.AddEdge(edge); });
  };
  EXPECT_EQ(message([](GraphEdge& edge) { edge.to = 9; }),
            "pose graph: loop 0 -> 9: keyframe 9 is unknown");
  EXPECT_EQ(message([](GraphEdge& edge) { edge.to = 0; }),
            "pose graph: loop 0 -> 0: joins a keyframe to itself");
  EXPECT_EQ(message([](GraphEdge& edge) { edge.T_from_to.linear() *= 1.1; }),
            "pose graph: loop 0 -> 2: its pose is not a finite rigid transform");
  EXPECT_EQ(message([](GraphEdge& edge) {
              edge.information(2, 2) = std::numeric_limits<double>::infinity();
            }),
            "pose graph: loop 0 -> 2: its information is not finite");
  EXPECT_EQ(message([](GraphEdge& edge) { edge.information(0, 1) = 0.5; }),
            "pose graph: loop 0 -> 2: its information is not symmetric");
  EXPECT_EQ(message([](GraphEdge& edge) { edge.information(3, 3) = -1.0; }),
            "pose graph: loop 0 -> 2: its information is not positive semidefinite");
  EXPECT_EQ(message([](GraphEdge& edge) { edge.information.setZero(); }),
            "pose graph: loop 0 -> 2: its information is not positive semidefinite");
  EXPECT_TRUE(graph.edges().empty());
}

TEST(PoseGraph, OdometryIsAChain) {
  PoseGraph graph;
  for (std::uint32_t id = 0; id < 4; ++id) graph.AddVertex(id, Time(), Pose::Identity());
  const auto add = [&](std::uint32_t from, std::uint32_t to) {
    GraphEdge edge;
    edge.from = from;
    edge.to = to;
    return MessageOf([&] { graph.AddEdge(edge); });
  };
  EXPECT_EQ(add(0, 1), "");
  EXPECT_EQ(add(3, 2), "pose graph: odometry edge 3 -> 2: must lead to a later keyframe");
  EXPECT_EQ(add(0, 2),
            "pose graph: odometry edge 0 -> 2: another odometry edge leaves the first keyframe "
            "already");
  EXPECT_EQ(add(1, 3), "");
  EXPECT_EQ(add(2, 3),
            "pose graph: odometry edge 2 -> 3: another odometry edge leads to the second keyframe "
            "already");
}

TEST(PoseGraphConfig, DefaultsAreValidAndMistakesAreNamed) {
  ConfigProblems none;
  PoseGraphConfig().Validate(none);
  EXPECT_TRUE(none.lines().empty());
  PoseGraphConfig wrong;
  wrong.inlier_probability = 1.0;
  wrong.odometry_gate_scale = 0.5;
  ConfigProblems problems;
  wrong.Validate(problems);
  EXPECT_EQ(problems.lines().size(), 2U);
}

}  // namespace
}  // namespace hv::loop
