#include "hv_navigation/obstacle_memory.h"

#include <gtest/gtest.h>

#include "grids.h"

namespace hv::navigation {
namespace {

using Eigen::Vector2d;

constexpr double kKeep_s = 60.0;
const Time kNow = Time::FromSeconds(100.0);
const PlanarPose kTurned{{3.0, 1.0}, 0.4};

SeenObstacles Seen(const OccupancyGrid& cells, const PlanarPose& T_map_grid) {
  return {std::make_shared<const ClearanceGrid>(cells, ClearanceGrid::Unknown::kFree, 1.0),
          T_map_grid};
}

/// Free but for a box of 0.4 m at (2, 2).
OccupancyGrid WithBox() {
  OccupancyGrid cells = EmptyCells(40, 40, 0.1);
  FillCells(cells, {1.8, 1.8}, {2.2, 2.2});
  return cells;
}

TEST(SeenObstaclesTest, TellsInTheFrameOfTheMap) {
  const SeenObstacles seen = Seen(WithBox(), kTurned);
  EXPECT_FALSE(seen.IsFreeAt(kTurned * Vector2d(2.0, 2.0)));
  EXPECT_TRUE(seen.IsFreeAt(kTurned * Vector2d(1.0, 2.0)));
  EXPECT_FALSE(seen.IsFreeAt(kTurned * Vector2d(-1.0, 2.0))) << "outside";
  OccupancyGrid unknown = EmptyCells(40, 40, 0.1);
  for (std::int8_t& cell : unknown.cells) cell = OccupancyGrid::kUnknown;
  EXPECT_FALSE(Seen(unknown, kTurned).IsFreeAt(kTurned * Vector2d(1.0, 2.0)));
}

TEST(SeenObstaclesTest, OnlyWhatTheMapLacksIsMissing) {
  const SeenObstacles seen = Seen(WithBox(), {});
  const ClearanceGrid empty(EmptyCells(40, 40, 0.1), ClearanceGrid::Unknown::kOccupied, 1.0);
  const ClearanceGrid same(WithBox(), ClearanceGrid::Unknown::kOccupied, 1.0);
  EXPECT_EQ(seen.MissingIn(empty).size(), 16U);
  EXPECT_TRUE(seen.MissingIn(same).empty());
  const ClearanceGrid small(EmptyCells(20, 20, 0.1), ClearanceGrid::Unknown::kOccupied, 1.0);
  EXPECT_EQ(seen.MissingIn(small).size(), 4U);
}

TEST(ObstacleMemoryTest, ForgetsWhatIsSeenFree) {
  ObstacleMemory memory(kKeep_s);
  memory.Add(kNow, {{2.0, 2.0}, {1.0, 1.0}, {7.0, 1.0}});
  memory.Review(kNow + 1.0, Seen(WithBox(), {}));
  const std::vector<Vector2d> places = memory.Places();
  ASSERT_EQ(places.size(), 2U);
  EXPECT_EQ(places[0], Vector2d(2.0, 2.0));
  EXPECT_EQ(places[1], Vector2d(7.0, 1.0)) << "out of sight";
}

TEST(ObstacleMemoryTest, ForgetsWhatIsOld) {
  ObstacleMemory memory(kKeep_s);
  const SeenObstacles nothing = Seen(EmptyCells(2, 2, 0.1), {});
  memory.Add(kNow, {{5.0, 5.0}});
  memory.Add(kNow + 30.0, {{6.0, 5.0}});
  memory.Review(kNow + 59.0, nothing);
  EXPECT_EQ(memory.Places().size(), 2U);
  memory.Review(kNow + 61.0, nothing);
  ASSERT_EQ(memory.Places().size(), 1U);
  EXPECT_EQ(memory.Places()[0], Vector2d(6.0, 5.0));
  for (int i = 0; i < 10; ++i) memory.Add(kNow + 62.0 + i, {{1.0, i + 0.0}});
  EXPECT_EQ(memory.Places().size(), 4U) << "bounded";
}

}  // namespace
}  // namespace hv::navigation
