#include "hv_explore_sac/unseen_ground.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace hv::explore {
namespace {

/// `#` is occupied, `.` free, `?` unknown. The first row is that of y = 0.
Belief Drawn(const std::vector<std::string>& rows, const Eigen::Vector2i& low) {
  Belief belief(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()), low);
  int index = 0;
  for (const std::string& row : rows) {
    for (const char cell : row) {
      const Cell known = cell == '#' ? Cell::kOccupied : Cell::kFree;
      belief.Set(index++, cell == '?' ? Cell::kUnknown : known);
    }
  }
  return belief;
}

std::vector<std::string> Rows(const Belief& belief) {
  std::vector<std::string> rows(static_cast<std::size_t>(belief.height()));
  for (int index = 0; index < belief.width() * belief.height(); ++index) {
    const Cell cell = belief.At(index);
    rows[static_cast<std::size_t>(index / belief.width())] +=
        cell == Cell::kOccupied ? '#' : (cell == Cell::kFree ? '.' : '?');
  }
  return rows;
}

/// What is left of a drawing that is ground and belief at once; the robot is at its cell (1, 1).
std::vector<std::string> Closed(const std::vector<std::string>& rows, double reach = 0.0,
                                const Eigen::Vector2i& low = {0, 0}) {
  Belief belief = Drawn(rows, low);
  CloseAllBut(Drawn(rows, low), low + Eigen::Vector2i(1, 1), reach, belief);
  return Rows(belief);
}

TEST(UnseenGroundTest, ClosesWhatNoWayLeadsTo) {
  const std::vector<std::string> rows = {"#########", "#...#..?#", "#..?#..?#", "#########"};
  EXPECT_EQ(Closed(rows),
            (std::vector<std::string>{"#########", "#...#..##", "#..?#..##", "#########"}));
  EXPECT_EQ(Closed(rows, 0.0, {-7, 5}), Closed(rows));
}

TEST(UnseenGroundTest, WaysMayLeadThroughTheUnknown) {
  const std::vector<std::string> rows = {"#########", "#...?..?#", "#...#..?#", "#########"};
  EXPECT_EQ(Closed(rows), rows);
}

TEST(UnseenGroundTest, WaysMayLeadAroundOutsideOfTheMap) {
  const std::vector<std::string> rows = {"#.#######", "#...#..?#", "#...#..??", "#########"};
  EXPECT_EQ(Closed(rows), rows);
  // Not over corners.
  const std::vector<std::string> corner = {"?########", "#...#..?#", "#...#..?#", "#########"};
  EXPECT_EQ(Closed(corner),
            (std::vector<std::string>{"#########", "#...#..##", "#...#..##", "#########"}));
}

TEST(UnseenGroundTest, WhatIsAroundUnseenGroundStaysUnknown) {
  Belief belief = Drawn({"########", "#.??????", "########"}, {0, 0});
  const Belief ground = Drawn({"########", "#.?#####", "########"}, {0, 0});
  CloseAllBut(ground, {1, 1}, 2.0, belief);
  EXPECT_EQ(Rows(belief), (std::vector<std::string>{"########", "#.???###", "########"}));
}

TEST(UnseenGroundTest, NothingUnknownIsLeftWhenAllGroundHasBeenSeen) {
  Belief belief = Drawn({"#####", "#..?#", "#####"}, {0, 0});
  const Belief ground = Drawn({"#####", "#..##", "#####"}, {0, 0});
  CloseAllBut(ground, {1, 1}, 100.0, belief);
  EXPECT_EQ(Rows(belief), (std::vector<std::string>{"#####", "#..##", "#####"}));
}

}  // namespace
}  // namespace hv::explore
