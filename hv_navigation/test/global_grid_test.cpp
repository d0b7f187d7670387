#include "hv_navigation/global_grid.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace hv::navigation {
namespace {

using Eigen::Vector2d;

OccupancyGrid Filled(double resolution_m, const Vector2d& origin, int width, int height,
                     std::int8_t value) {
  OccupancyGrid grid;
  grid.resolution_m = resolution_m;
  grid.origin = origin;
  grid.width = width;
  grid.height = height;
  grid.cells.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value);
  return grid;
}

void FillBox(OccupancyGrid& grid, const Vector2d& low, const Vector2d& high, std::int8_t value) {
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const Vector2d at = grid.origin + grid.resolution_m * Vector2d(x + 0.5, y + 0.5);
      if ((at.array() > low.array()).all() && (at.array() < high.array()).all()) {
        grid.At(x, y) = value;
      }
    }
  }
}

std::int8_t ValueAt(const OccupancyGrid& grid, const Vector2d& position) {
  const Eigen::Vector2i cell =
      ((position - grid.origin) / grid.resolution_m).array().floor().cast<int>();
  if (cell.minCoeff() < 0 || cell.x() >= grid.width || cell.y() >= grid.height) {
    return OccupancyGrid::kUnknown;
  }
  return grid.At(cell.x(), cell.y());
}

/// A room of 10 x 8 m with walls along two sides and a box of 0.5 m in the middle.
OccupancyGrid Room() {
  OccupancyGrid room = Filled(0.05, {0.0, 0.0}, 200, 160, OccupancyGrid::kFree);
  FillBox(room, {0.0, 0.0}, {10.0, 0.2}, OccupancyGrid::kOccupied);
  FillBox(room, {0.0, 0.0}, {0.2, 8.0}, OccupancyGrid::kOccupied);
  FillBox(room, {5.0, 4.0}, {5.5, 4.5}, OccupancyGrid::kOccupied);
  return room;
}

OccupancyGrid FreeView() { return Filled(0.1, {-3.0, -3.0}, 60, 60, OccupancyGrid::kFree); }

/// What is seen of a wall at y < 0.2 m of the map from a place within it.
OccupancyGrid WallView(const PlanarPose& T_map_odom) {
  OccupancyGrid view = FreeView();
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const bool in_wall = (T_map_odom * view.CenterOf({x, y})).y() < 0.2;
      if (in_wall) view.At(x, y) = OccupancyGrid::kOccupied;
    }
  }
  return view;
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(GlobalGridTest, WithoutViewsItIsTheSavedMap) {
  const OccupancyGrid room = Room();
  const GlobalGrid global({}, room);
  EXPECT_EQ(global.grid().cells, room.cells);
  EXPECT_EQ(global.grid().origin, room.origin);
}

TEST(GlobalGridTest, WallsGrowNoThicker) {
  OccupancyGrid hall = Filled(0.1, {0.0, 0.0}, 100, 80, OccupancyGrid::kFree);
  FillBox(hall, {0.0, 0.0}, {10.0, 0.2}, OccupancyGrid::kOccupied);
  const OccupancyGrid view = WallView({{5.0, 1.5}, 0.3});
  GlobalGrid global({}, hall);
  for (int i = 0; i < 10; ++i) global.Update(view, {{5.02, 1.54}, 0.31}, {0.0, 0.0});
  const Eigen::Vector2i low = global.grid().CellOf({2.5, 0.25});
  const Eigen::Vector2i high = global.grid().CellOf({7.5, 0.85});
  for (int y = low.y(); y <= high.y(); ++y) {
    for (int x = low.x(); x <= high.x(); ++x) EXPECT_EQ(global.grid().At(x, y), 0) << x << ' ' << y;
  }
}

TEST(GlobalGridTest, ObstaclesAreAddedWhereTheyAre) {
  for (const double yaw : {0.0, 0.4, 2.0}) {
    OccupancyGrid view = FreeView();
    FillBox(view, {1.0, -1.5}, {1.1, 1.5}, OccupancyGrid::kOccupied);
    const PlanarPose T_map_odom{{3.0, 4.0}, yaw};
    GlobalGrid global({}, Room());
    global.Update(view, T_map_odom, {0.0, 0.0});
    EXPECT_EQ(ValueAt(global.grid(), T_map_odom * Vector2d(1.05, 1.0)), OccupancyGrid::kFree);
    global.Update(view, T_map_odom, {0.0, 0.0});
    for (double y = -1.45; y < 1.5; y += 0.05) {
      EXPECT_EQ(ValueAt(global.grid(), T_map_odom * Vector2d(1.05, y)), OccupancyGrid::kOccupied);
    }
    EXPECT_NE(ValueAt(global.grid(), T_map_odom * Vector2d(0.7, 0.0)), OccupancyGrid::kOccupied);
  }
}

TEST(GlobalGridTest, ObstaclesThatLeaveAreTakenAway) {
  OccupancyGrid view = FreeView();
  FillBox(view, {1.0, 1.0}, {1.3, 1.3}, OccupancyGrid::kOccupied);
  const PlanarPose T_map_odom{{3.0, 4.0}, 0.0};
  GlobalGrid global({}, Room());
  for (int i = 0; i < 20; ++i) global.Update(view, T_map_odom, {0.0, 0.0});
  const Vector2d at = T_map_odom * Vector2d(1.15, 1.15);
  EXPECT_EQ(ValueAt(global.grid(), at), OccupancyGrid::kOccupied);
  for (int i = 0; i < 4; ++i) global.Update(FreeView(), T_map_odom, {0.0, 0.0});
  EXPECT_EQ(ValueAt(global.grid(), at), OccupancyGrid::kOccupied);
  global.Update(FreeView(), T_map_odom, {0.0, 0.0});
  EXPECT_EQ(ValueAt(global.grid(), at), OccupancyGrid::kFree);
}

TEST(GlobalGridTest, AdditionsToASavedMapCanBeForgotten) {
  OccupancyGrid view = FreeView();
  FillBox(view, {1.0, 1.0}, {1.3, 1.3}, OccupancyGrid::kOccupied);
  const PlanarPose T_map_odom{{5.25, 4.25}, 0.0};
  const Vector2d at = T_map_odom * Vector2d(1.15, 1.15);
  for (const bool saved : {true, false}) {
    GlobalGrid global = saved ? GlobalGrid({}, Room()) : GlobalGrid({});
    EXPECT_FALSE(global.has_additions());
    for (int i = 0; i < 20; ++i) global.Update(view, T_map_odom, {0.0, 0.0});
    EXPECT_EQ(global.has_additions(), saved);
    global.ForgetAdditions();
    EXPECT_FALSE(global.has_additions());
    EXPECT_EQ(OccupancyGrid::IsOccupied(ValueAt(global.grid(), at)), !saved);
    EXPECT_EQ(ValueAt(global.grid(), T_map_odom.position), OccupancyGrid::kFree)
        << "was taken away";
    for (int i = 0; i < 2; ++i) global.Update(view, T_map_odom, {0.0, 0.0});
    EXPECT_EQ(ValueAt(global.grid(), at), OccupancyGrid::kOccupied) << "is seen again";
  }
}

TEST(GlobalGridTest, FreeViewsRemoveFurnitureFromNearAndNoWalls) {
  const Vector2d on_wall(3.0, 0.1);
  const Vector2d on_box(5.25, 4.25);
  const OccupancyGrid view = Filled(0.1, {-8.0, -8.0}, 160, 160, OccupancyGrid::kFree);
  GlobalGrid far({}, Room());
  for (int i = 0; i < 50; ++i) far.Update(view, {{1.0, 4.0}, 0.0}, {0.0, 0.0});
  EXPECT_EQ(ValueAt(far.grid(), on_box), OccupancyGrid::kOccupied);
  GlobalGrid near({}, Room());
  for (int i = 0; i < 50; ++i) near.Update(view, {{3.0, 2.0}, 0.0}, {0.0, 0.0});
  EXPECT_EQ(ValueAt(near.grid(), on_box), OccupancyGrid::kFree);
  EXPECT_EQ(ValueAt(near.grid(), on_wall), OccupancyGrid::kOccupied);
  near.ForgetViews();
  EXPECT_EQ(ValueAt(near.grid(), on_box), OccupancyGrid::kOccupied);
}

TEST(GlobalGridTest, GrowsWithoutMovingWhatItHolds) {
  GlobalGrid global({});
  OccupancyGrid view = FreeView();
  FillBox(view, {-1.0, -1.0}, {-0.7, -0.7}, OccupancyGrid::kOccupied);
  for (int i = 0; i < 3; ++i) global.Update(view, {}, {0.0, 0.0});
  for (int i = 0; i < 40; ++i) {
    view = FreeView();
    view.origin += Vector2d(-0.5 * i - 5.0, 0.3 * i + 5.0);
    global.Update(view, {}, view.origin + Vector2d(3.0, 3.0));
  }
  EXPECT_EQ(ValueAt(global.grid(), {-0.85, -0.85}), OccupancyGrid::kOccupied);
  EXPECT_EQ(ValueAt(global.grid(), {0.5, 0.5}), OccupancyGrid::kFree);
  EXPECT_EQ(ValueAt(global.grid(), {-24.0, 16.0}), OccupancyGrid::kFree);
  EXPECT_EQ(ValueAt(global.grid(), {2.0, 15.0}), OccupancyGrid::kUnknown);
  EXPECT_EQ(global.left_out(), 0U);
}

TEST(GlobalGridTest, StaysWithinItsLargestSize) {
  GlobalGridConfig config;
  config.max_side_m = 30.0;
  GlobalGrid global(config);
  for (int i = 0; i < 40; ++i) {
    global.Update(FreeView(), {{2.0 * i, 0.0}, 0.1 * i}, {0.0, 0.0});
  }
  EXPECT_LE(global.grid().width, 300);
  EXPECT_LE(global.grid().height, 300);
  EXPECT_GT(global.left_out(), 0U);
}

TEST(GlobalGridTest, BadViewsChangeNothing) {
  GlobalGrid global({}, Room());
  const PlanarPose pose{{3.0, 4.0}, 0.0};
  OccupancyGrid torn = FreeView();
  torn.cells.pop_back();
  for (int i = 0; i < 9; ++i) {
    global.Update({}, pose, {0.0, 0.0});
    global.Update(torn, pose, {0.0, 0.0});
    global.Update(FreeView(), {{kNan, 0.0}, 0.0}, {0.0, 0.0});
    global.Update(FreeView(), {{3.0, 4.0}, kNan}, {0.0, 0.0});
    global.Update(FreeView(), {{1e30, 4.0}, 0.0}, {0.0, 0.0});
    global.Update(FreeView(), pose, {kNan, 0.0});
  }
  EXPECT_EQ(global.grid().cells, Room().cells);
}

TEST(GlobalGridTest, TellsWhatHasChanged) {
  GlobalGridConfig config;
  config.mark_views = 1;
  GlobalGrid global(config, Room());
  EXPECT_TRUE(global.TakeChanges().everything);

  OccupancyGrid view = Filled(0.05, {3.0, 3.0}, 40, 40, OccupancyGrid::kFree);
  global.Update(view, {}, {4.0, 4.0});
  EXPECT_FALSE(global.TakeChanges().cells);
  view.At(10, 20) = view.At(12, 25) = OccupancyGrid::kOccupied;
  global.Update(view, {}, {4.0, 4.0});
  const GlobalGrid::Changes changes = global.TakeChanges();
  EXPECT_FALSE(changes.everything);
  ASSERT_TRUE(changes.cells);
  EXPECT_EQ(changes.cells->low, Eigen::Vector2i(70, 80));
  EXPECT_EQ(changes.cells->high, Eigen::Vector2i(72, 85));
  EXPECT_FALSE(global.TakeChanges().cells);

  global.Update(FreeView(), {}, {0.0, 0.0});
  EXPECT_TRUE(global.TakeChanges().everything) << "grew";
  global.ForgetViews();
  EXPECT_TRUE(global.TakeChanges().everything) << "forgot";
}

}  // namespace
}  // namespace hv::navigation
