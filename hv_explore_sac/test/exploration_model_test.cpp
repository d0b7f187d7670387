#include "hv_explore_sac/exploration_model.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "hv_explore_sac/ray_sensor.h"
#include "random_maps.h"

namespace hv::explore {
namespace {

using Place = std::pair<int, int>;

Place PlaceOf(const Eigen::Vector2i& cell) { return {cell.x(), cell.y()}; }

std::set<int> Sorted(const std::vector<int>& values) { return {values.begin(), values.end()}; }

/// Edges and what is seen, by place, so that the numbers of viewpoints do not matter.
struct Contents {
  std::map<Place, std::set<std::pair<Place, float>>> edges;
  std::map<Place, std::set<int>> seen;
};

Contents ContentsOf(const ViewpointGraph& graph, const FrontierViews& views) {
  Contents contents;
  std::vector<int> points;
  for (int viewpoint = 0; viewpoint < graph.size(); ++viewpoint) {
    const Place place = PlaceOf(graph.CellOf(viewpoint));
    auto& edges = contents.edges[place];
    for (const ViewpointGraph::Edge& edge : graph.EdgesOf(viewpoint)) {
      edges.insert({PlaceOf(graph.CellOf(edge.to)), edge.length});
    }
    views.ListSeen(viewpoint, points);
    contents.seen[place] = Sorted(points);
  }
  return contents;
}

/// The same as `model`, made from its belief at once.
void ExpectEqualToScratch(const ExplorationModel& model, const ExplorationConfig& config,
                          const std::vector<Eigen::Vector2i>& added) {
  const Belief& belief = model.belief();
  const Frontiers frontiers(config.frontier, belief);
  EXPECT_EQ(Sorted(model.frontiers().points()), Sorted(frontiers.points()));
  ViewpointGraph graph(config.viewpoint, belief);
  for (const Eigen::Vector2i& cell : added) {
    if (belief.At(cell) == Cell::kFree) graph.Add(cell, belief);
  }
  FrontierViews views(config.viewpoint);
  views.Update(belief, frontiers, graph);
  const Contents expected = ContentsOf(graph, views);
  const Contents actual = ContentsOf(model.graph(), model.views());
  EXPECT_EQ(actual.edges, expected.edges);
  EXPECT_EQ(actual.seen, expected.seen);
}

class Increments : public testing::TestWithParam<unsigned> {};

TEST_P(Increments, EqualRecomputationWhileSensing) {
  const ExplorationConfig config;
  const RaySensor sensor(config.simulation);
  const ExplorationMap map = RandomMap(GetParam());
  ExplorationModel model(config, map.width, map.height);
  std::mt19937 random(GetParam());
  std::vector<Eigen::Vector2i> stood;
  Eigen::Vector2i at = map.start;
  for (int step = 0; step < 8; ++step) {
    sensor.Sense(map, at, model.belief());
    model.Update(at);
    stood.push_back(at);
    ExpectEqualToScratch(model, config, stood);
    const auto& edges = model.graph().EdgesOf(model.robot());
    ASSERT_FALSE(edges.empty());
    const auto next = std::uniform_int_distribution<std::size_t>(0, edges.size() - 1)(random);
    at = Eigen::Vector2i(model.graph().CellOf(edges[next].to));
  }
}

TEST_P(Increments, EqualRecomputationWhenCellsChangeAnyWay) {
  const ExplorationConfig config;
  ExplorationModel model(config, 120, 100);
  std::mt19937 random(GetParam());
  std::uniform_int_distribution<int> corner_x(0, 119);
  std::uniform_int_distribution<int> corner_y(0, 99);
  std::uniform_int_distribution<int> kind(0, 5);
  const Eigen::Vector2i stand(50, 50);
  for (int step = 0; step < 12; ++step) {
    const Eigen::Array2i low(corner_x(random), corner_y(random));
    const int drawn = kind(random);
    const Cell cell = drawn == 0 ? Cell::kUnknown : drawn == 1 ? Cell::kOccupied : Cell::kFree;
    for (int y = low.y(); y < std::min(100, low.y() + 40); ++y) {
      for (int x = low.x(); x < std::min(120, low.x() + 40); ++x) {
        model.belief().Set(model.belief().IndexOf({x, y}), cell);
      }
    }
    model.belief().Set(model.belief().IndexOf(stand), Cell::kFree);
    model.Update(stand);
    ExpectEqualToScratch(model, config, {stand});
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, Increments, testing::Range(1U, 7U));

TEST(ViewpointGraphTest, EdgesAreFreeFewAndSorted) {
  const ExplorationConfig config;
  const ExplorationMap map = RandomMap(11);
  ExplorationModel model(config, map.width, map.height);
  RaySensor(config.simulation).Sense(map, map.start, model.belief());
  model.Update(map.start);
  const ViewpointGraph& graph = model.graph();
  for (int viewpoint = 0; viewpoint < graph.size(); ++viewpoint) {
    const auto& edges = graph.EdgesOf(viewpoint);
    EXPECT_LE(edges.size(), static_cast<std::size_t>(config.viewpoint.neighbors));
    EXPECT_TRUE(std::is_sorted(edges.begin(), edges.end(),
                               [](const auto& a, const auto& b) { return a.length < b.length; }));
    for (const ViewpointGraph::Edge& edge : edges) {
      const Eigen::Vector2i& from = graph.CellOf(viewpoint);
      const Eigen::Vector2i& to = graph.CellOf(edge.to);
      EXPECT_FLOAT_EQ(edge.length, (to - from).cast<float>().norm());
      // Every point of the segment lies in a cell that is free or touches one.
      for (double share = 0.0; share <= 1.0; share += 0.01) {
        const Eigen::Vector2i cell =
            (from.cast<double>() + share * (to - from).cast<double>()).array().round().cast<int>();
        bool free = false;
        for (int i = 0; i < 9; ++i) {
          const Eigen::Vector2i near = cell + Eigen::Vector2i(i % 3 - 1, i / 3 - 1);
          free |= model.belief().Contains(near) && model.belief().At(near) == Cell::kFree;
        }
        EXPECT_TRUE(free);
      }
    }
  }
}

TEST(ObservationTest, DistancesAndPredecessorsBelongTogether) {
  const ExplorationConfig config;
  const ExplorationMap map = RandomMap(12);
  ExplorationModel model(config, map.width, map.height);
  RaySensor(config.simulation).Sense(map, map.start, model.belief());
  model.Update(map.start);
  Observation observation;
  model.Observe(observation);
  ASSERT_GT(observation.size(), 5);
  EXPECT_EQ(observation.node(Observation::kRobot).viewpoint, model.robot());
  EXPECT_EQ(observation.history, std::vector<int>{Observation::kRobot});
  for (int i = 1; i < observation.size(); ++i) {
    const Observation::Node& node = observation.node(i);
    ASSERT_LT(node.predecessor, i);
    const auto edges = observation.EdgesOf(node.predecessor);
    const auto edge =
        std::find_if(edges.begin(), edges.end(), [i](const auto& each) { return each.to == i; });
    ASSERT_NE(edge, edges.end());
    EXPECT_FLOAT_EQ(node.distance, observation.node(node.predecessor).distance + edge->length);
    EXPECT_GE(node.distance, node.position.norm() * 0.9999F);
    const auto actions = observation.Actions();
    EXPECT_TRUE(std::any_of(actions.begin(), actions.end(), [&](const auto& action) {
      return action.to == observation.FirstHopTo(i);
    }));
  }
}

TEST(ObservationTest, RemembersTheLastViewpoints) {
  const ExplorationConfig config;
  ExplorationModel model(config, 200, 200);
  for (int cell = 0; cell < 200 * 200; ++cell) model.belief().Set(cell, Cell::kFree);
  for (int i = 0; i < 50; ++i) model.Update({2 * i + 1, 3});
  Observation observation;
  model.Observe(observation);
  ASSERT_EQ(observation.history.size(), Observation::kHistory);
  const int oldest = observation.node(observation.history.front()).viewpoint;
  EXPECT_EQ(model.graph().CellOf(oldest), Eigen::Vector2i(2 * 18 + 1, 3));
  EXPECT_EQ(observation.history.back(), Observation::kRobot);
}

/// Two rooms with a door of `door` cells between them, and a robot that takes up `margin` cells to
/// every side.
ExplorationModel TwoRoomsWithADoor(int door, int margin) {
  constexpr int kWidth = 60;
  constexpr int kHeight = 40;
  ExplorationConfig config;
  config.viewpoint.spacing_x = config.viewpoint.spacing_y = 8.0;
  ExplorationModel model(config, kWidth, kHeight);
  Belief ground = model.belief();
  const auto is_wall = [door](int x, int y) {
    if (x < 0 || y < 0 || x >= kWidth || y >= kHeight) return true;
    const bool in_door = y >= 19 && y < 19 + door;
    return x >= 29 && x < 32 && !in_door;
  };
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      bool near = false;
      for (int i = -margin; i <= margin; ++i) near |= is_wall(x + i, y) || is_wall(x, y + i);
      const int index = ground.IndexOf({x, y});
      model.belief().Set(index, is_wall(x, y) ? Cell::kOccupied : Cell::kFree);
      ground.Set(index, near ? Cell::kOccupied : Cell::kFree);
    }
  }
  model.SetGround(std::move(ground));
  model.Update({10, 10});
  return model;
}

bool ReachesTheOtherRoom(const ExplorationModel& model) {
  const std::vector<int>& reached = model.ways().order();
  return std::any_of(reached.begin(), reached.end(),
                     [&model](int viewpoint) { return model.graph().CellOf(viewpoint).x() > 35; });
}

TEST(GroundTest, ViewpointsAndEdgesLieWhereTheRobotMayStand) {
  const ExplorationModel model = TwoRoomsWithADoor(7, 3);
  for (int viewpoint = 0; viewpoint < model.graph().size(); ++viewpoint) {
    const Eigen::Vector2i& cell = model.graph().CellOf(viewpoint);
    EXPECT_EQ(model.ground().At(cell), Cell::kFree);
    for (const ViewpointGraph::Edge& edge : model.graph().EdgesOf(viewpoint)) {
      const Eigen::Vector2i& to = model.graph().CellOf(edge.to);
      const bool free = model.ground().FirstBlocked(cell, to) == Belief::kNone ||
                        model.ground().FirstBlocked(to, cell) == Belief::kNone;
      EXPECT_TRUE(free);
    }
  }
}

TEST(GroundTest, NarrowDoorsAreBridged) {
  EXPECT_TRUE(ReachesTheOtherRoom(TwoRoomsWithADoor(7, 3)));   // a row of cells is left
  EXPECT_FALSE(ReachesTheOtherRoom(TwoRoomsWithADoor(6, 3)));  // none is
}

TEST(RecallTest, BringsBackWhereTheRobotStood) {
  ExplorationModel model(ExplorationConfig(), 200, 200, {-50, -100});
  for (int cell = 0; cell < 200 * 200; ++cell) model.belief().Set(cell, Cell::kFree);
  model.belief().Set(model.belief().IndexOf({7, 7}), Cell::kOccupied);
  model.Recall({{7, 7}, {-30, -90}, {3, 5}, {1000, 3}}, 6.0);
  model.Update({20, 20});
  const ViewpointGraph& graph = model.graph();
  EXPECT_LT(graph.At({7, 7}), 0);
  EXPECT_TRUE(graph.Visited(graph.At({-30, -90})));
  EXPECT_TRUE(graph.Visited(graph.At({0, 0})));  // of the lattice, 5.8 cells from where it stood
  EXPECT_FALSE(graph.Visited(graph.At({22, 0})));
  Observation observation;
  model.Observe(observation);
  ASSERT_EQ(observation.history.size(), 3U);
  EXPECT_EQ(graph.CellOf(observation.node(observation.history[1]).viewpoint),
            Eigen::Vector2i(3, 5));
}

/// The robot has stood at `stood` on a large free place with an unknown spot in its middle.
ExplorationModel AroundASpot(double new_side_deg, const Eigen::Vector2i& stood) {
  ExplorationConfig config;
  config.viewpoint.spacing_x = config.viewpoint.spacing_y = 10.0;
  config.viewpoint.min_utility = 3;
  config.viewpoint.new_side_deg = new_side_deg;
  ExplorationModel model(config, 200, 200);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      const bool unknown = std::abs(x - 100) < 8 && std::abs(y - 100) < 8;
      model.belief().Set(model.belief().IndexOf({x, y}), unknown ? Cell::kUnknown : Cell::kFree);
    }
  }
  model.Update(stood);
  return model;
}

int UtilityAt(const ExplorationModel& model, const Eigen::Vector2i& cell) {
  const int viewpoint = model.graph().At(cell);
  EXPECT_GE(viewpoint, 0);
  return model.UtilityOf(viewpoint);
}

TEST(NewSideTest, FarViewsShowNothingThatTheRobotHasNotSeen) {
  const Eigen::Vector2i farther(30, 100);
  EXPECT_GT(UtilityAt(AroundASpot(0.0, {60, 100}), farther), 0);
  EXPECT_EQ(UtilityAt(AroundASpot(60.0, {60, 100}), farther), 0);
}

TEST(NewSideTest, ViewsFromNearerAndFromElsewhereCount) {
  const ExplorationModel model = AroundASpot(60.0, {60, 100});
  EXPECT_GT(UtilityAt(model, {80, 100}), 0);
  EXPECT_GT(UtilityAt(model, {140, 100}), 0);
  EXPECT_EQ(UtilityAt(model, {140, 100}), UtilityAt(AroundASpot(0.0, {60, 100}), {140, 100}));
}

TEST(NewSideTest, LooksFromAllSidesLeaveNothing) {
  ExplorationModel model = AroundASpot(60.0, {60, 100});
  for (const Eigen::Vector2i& cell :
       {Eigen::Vector2i(140, 100), Eigen::Vector2i(100, 60), Eigen::Vector2i(100, 140)}) {
    model.Update(cell);
  }
  EXPECT_EQ(UtilityAt(model, {150, 150}), 0);
  EXPECT_EQ(UtilityAt(model, {40, 90}), 0);
}

}  // namespace
}  // namespace hv::explore
