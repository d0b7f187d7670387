#include "hv_ros/message_checks.h"

#include <cmath>

#include <gtest/gtest.h>

#include "hv_ros/conversions.h"

namespace hv {
namespace {

nav_msgs::OccupancyGrid SomeGrid() {
  OccupancyGrid grid;
  grid.resolution_m = 0.05;
  grid.origin = {-3.0, 2.0};
  grid.width = 3;
  grid.height = 2;
  grid.cells = {-1, 0, 100, 20, 60, -1};
  return ToGridMessage(grid);
}

TEST(MessageChecks, GridsSurviveTheWayThroughRos) {
  OccupancyGrid grid;
  ASSERT_EQ(ReadGrid(SomeGrid(), grid), "");
  EXPECT_NEAR(grid.resolution_m, 0.05, 1e-8);
  EXPECT_EQ(grid.origin, Eigen::Vector2d(-3.0, 2.0));
  EXPECT_EQ(grid.width, 3);
  EXPECT_EQ(grid.height, 2);
  EXPECT_EQ(grid.cells, (std::vector<std::int8_t>{-1, 0, 100, 20, 60, -1}));
}

TEST(MessageChecks, GridsThatMakeNoSenseAreRefused) {
  const auto problem = [](auto spoil) {
    nav_msgs::OccupancyGrid message = SomeGrid();
    spoil(message);
    OccupancyGrid grid;
    return ReadGrid(message, grid);
  };
  EXPECT_NE(problem([](auto& grid) { grid.info.resolution = 0.0F; }), "");
  EXPECT_NE(problem([](auto& grid) { grid.info.resolution = NAN; }), "");
  EXPECT_NE(problem([](auto& grid) { grid.info.width = 0; }), "");
  EXPECT_NE(problem([](auto& grid) { grid.data.pop_back(); }), "");
  EXPECT_NE(problem([](auto& grid) { grid.info.origin.position.x = NAN; }), "");
  EXPECT_NE(problem([](auto& grid) { grid.info.origin.orientation.w = 0.0; }), "");
  EXPECT_NE(problem([](auto& grid) {
              grid.info.origin.orientation.z = std::sqrt(0.5);
              grid.info.origin.orientation.w = std::sqrt(0.5);
            }),
            "");
}

}  // namespace
}  // namespace hv
