#include "viewpoint_markers.h"

#include <set>

#include <gtest/gtest.h>
#include <ros/time.h>

#include "toy_building.h"

namespace hv::explore {
namespace {

using visualization_msgs::Marker;

class ViewpointMarkersTest : public testing::Test {
 protected:
  ViewpointMarkersTest()
      : chooser_(ExplorerConfig(), kRobotSize, Bounds(),
                 [](const PlannerInputs& inputs) { return MakePlanner("utility", inputs); }) {
    ros::Time::init();
  }

  GoalChooser chooser_;
};

TEST_F(ViewpointMarkersTest, WithoutAMapOnlyClear) {
  const auto array = ToViewpointMarkers(chooser_, std::nullopt, "map", 0.0);
  ASSERT_EQ(array.markers.size(), 1U);
  EXPECT_EQ(array.markers[0].action, Marker::DELETEALL);
  EXPECT_TRUE(FrontierCloud(chooser_, 0.0).empty());
}

TEST_F(ViewpointMarkersTest, ShowTheGraphAndTheGoal) {
  const ToyRobot robot(TwoRooms(), {6.05, 1.25});
  chooser_.NoteStood(robot.pose().position);
  ASSERT_EQ(chooser_.Look(robot.known(), robot.pose().position), Outlook::kGoals);
  const ViewpointGoal goal = chooser_.Choose(true);
  const auto array = ToViewpointMarkers(chooser_, goal, "map", 0.5);
  std::set<std::string> names;
  for (const Marker& marker : array.markers) {
    EXPECT_EQ(marker.header.frame_id, "map");
    names.insert(marker.ns);
    if (marker.ns == "viewpoints") {
      EXPECT_EQ(marker.points.size(), marker.colors.size());
      EXPECT_EQ(static_cast<int>(marker.points.size()), chooser_.model()->graph().size());
    }
    if (marker.ns == "goal") {
      EXPECT_DOUBLE_EQ(marker.pose.position.x, goal.pose.position.x());
    }
    if (marker.ns == "way") {
      EXPECT_DOUBLE_EQ(marker.points.back().z, 0.5);
    }
  }
  EXPECT_EQ(names, (std::set<std::string>{"", "viewpoints", "edges", "utilities", "way", "goal"}));
}

TEST_F(ViewpointMarkersTest, FrontiersLieWhereTheKnownEnds) {
  const ToyRobot robot(TwoRooms(), {6.05, 1.25});
  chooser_.Look(robot.known(), robot.pose().position);
  const std::vector<Point> cloud = FrontierCloud(chooser_, 0.5);
  ASSERT_EQ(cloud.size(), chooser_.model()->frontiers().points().size());
  ASSERT_FALSE(cloud.empty());
  const OccupancyGrid& map = robot.known();
  for (const Point& point : cloud) {
    const Eigen::Vector2i cell = map.CellOf(Eigen::Vector2d(point.x, point.y));
    EXPECT_EQ(map.At(cell.x(), cell.y()), OccupancyGrid::kFree);
  }
}

}  // namespace
}  // namespace hv::explore
