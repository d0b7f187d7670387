#include "hv_explore_sac/known_place.h"

#include <gtest/gtest.h>

#include "toy_building.h"

namespace hv::explore {
namespace {

const CellFrame kFrame{0.1, Eigen::Vector2d::Zero()};

ExplorationModel Model(const OccupancyGrid& map, const CellFrame& frame, const PlaceRules& rules) {
  const navigation::ClearanceGrid clearance(map, navigation::ClearanceGrid::Unknown::kFree, 1.0);
  return ModelOf(clearance, frame, rules, ExplorationConfig());
}

TEST(KnownPlaceTest, KeepsTheRobotFromObstaclesAndTheOutside) {
  OccupancyGrid map = Drawn({"##########", "#........#", "#........#", "#........#", "##########"});
  map.At(20, 7) = OccupancyGrid::kUnknown;
  map.At(20, 12) = OccupancyGrid::kUnknown;
  const Bounds bounds({{0.0, 0.0}, {4.0, 0.0}, {4.0, 3.0}, {0.0, 3.0}});
  const ExplorationModel model = Model(map, kFrame, {0.28, bounds});
  const auto at = [&](double x, double y) { return model.ground().At(kFrame.CellOf({x, y})); };
  EXPECT_EQ(at(0.75, 1.25), Cell::kOccupied);  // 0.25 m from the wall
  EXPECT_EQ(at(0.85, 1.25), Cell::kFree);
  EXPECT_EQ(at(2.05, 1.25), Cell::kUnknown);
  EXPECT_EQ(at(2.05, 0.75), Cell::kOccupied);  // unknown, but where the robot cannot stand
  EXPECT_EQ(model.belief().At(kFrame.CellOf({2.05, 0.75})), Cell::kUnknown);
  EXPECT_EQ(model.belief().At(kFrame.CellOf({0.75, 1.25})), Cell::kFree);
  EXPECT_EQ(at(3.95, 1.25), Cell::kFree);
  EXPECT_EQ(at(4.05, 1.25), Cell::kOccupied);
}

TEST(KnownPlaceTest, WhereTheRobotHasDrivenItCanDrive) {
  OccupancyGrid map = Drawn({"##########", "#...#....#", "#........#", "#...#....#", "##########"});
  PlaceRules rules{0.28, {}};
  const Eigen::Vector2i door = kFrame.CellOf({2.25, 1.25});
  EXPECT_EQ(Model(map, kFrame, rules).ground().At(door), Cell::kOccupied);
  rules.driven = {kFrame.CellOf({1.25, 1.25}), kFrame.CellOf({1.75, 1.25}),
                  kFrame.CellOf({3.25, 1.25})};
  const Belief ground = Model(map, kFrame, rules).ground();
  for (int x = rules.driven.front().x(); x <= rules.driven.back().x(); ++x) {
    EXPECT_EQ(ground.At(Eigen::Vector2i(x, door.y())), Cell::kFree);
  }
  EXPECT_EQ(ground.At(kFrame.CellOf({2.25, 1.05})), Cell::kOccupied);
  // Unless something is there now.
  map.At(door.x(), door.y()) = OccupancyGrid::kOccupied;
  EXPECT_EQ(Model(map, kFrame, rules).ground().At(door), Cell::kOccupied);
  // What it was carried over it has not driven.
  map.At(door.x(), door.y()) = OccupancyGrid::kFree;
  rules.driven = {kFrame.CellOf({1.05, 1.25}), kFrame.CellOf({3.25, 1.25})};
  EXPECT_EQ(Model(map, kFrame, rules).ground().At(door), Cell::kOccupied);
}

TEST(KnownPlaceTest, CellsKeepTheirNamesWhenTheMapGrows) {
  const OccupancyGrid small = Drawn({"......", "......", "......"}, {1.0, 2.0});
  OccupancyGrid large =
      Drawn({"..........", "..........", "..........", ".........."}, {-0.3, 1.7});
  const CellFrame frame{0.1, small.origin};
  ExplorationModel before = Model(small, frame, {});
  ExplorationModel after = Model(large, frame, {});
  before.Recall({}, 0.0);
  after.Recall({}, 0.0);
  EXPECT_EQ(before.belief().low(), Eigen::Vector2i(0, 0));
  EXPECT_EQ(after.belief().low(), Eigen::Vector2i(-16, -4));  // whole blocks of four
  EXPECT_EQ(after.belief().At(Eigen::Vector2i(-13, -3)), Cell::kFree);
  EXPECT_EQ(after.belief().At(Eigen::Vector2i(-14, -3)), Cell::kUnknown);
  ASSERT_GT(before.graph().size(), 0);
  for (int viewpoint = 0; viewpoint < before.graph().size(); ++viewpoint) {
    EXPECT_GE(after.graph().At(before.graph().CellOf(viewpoint)), 0);
  }
}

TEST(KnownPlaceTest, FindsTheNearestFreeCell) {
  const OccupancyGrid map = Drawn({"####", "#..#", "#..#", "####"});
  const ExplorationModel model = Model(map, kFrame, {0.28, {}});
  EXPECT_EQ(NearestFree(model.ground(), kFrame, {0.55, 1.05}, 1.0), Eigen::Vector2i(8, 10));
  EXPECT_EQ(NearestFree(model.ground(), kFrame, {-3.0, 1.0}, 1.0), std::nullopt);
  EXPECT_EQ(NearestFree(model.ground(), kFrame, {1e300, 1.0}, 1.0), std::nullopt);
}

TEST(KnownPlaceTest, MeasuresWhatIsFreeInsideOfTheBounds) {
  const OccupancyGrid map = Drawn({"####", "#..#", "#..#", "####"});
  EXPECT_NEAR(FreeArea(map, {}), 1.0, 1e-9);
  const Bounds half({{0.0, 0.0}, {1.0, 0.0}, {1.0, 2.0}, {0.0, 2.0}});
  EXPECT_NEAR(FreeArea(map, half), 0.5, 1e-9);
}

}  // namespace
}  // namespace hv::explore
