#include "hv_explore_sac/gates.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace hv::explore {
namespace {

using Rows = std::vector<std::string>;

/// `#` is occupied, `.` free, `?` unknown. The first row is that of y = 0.
Belief Drawn(const Rows& rows, const Eigen::Vector2i& low = Eigen::Vector2i::Zero()) {
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

Rows RowsOf(const Belief& belief) {
  Rows rows(static_cast<std::size_t>(belief.height()));
  for (int index = 0; index < belief.width() * belief.height(); ++index) {
    const Cell cell = belief.At(index);
    rows[static_cast<std::size_t>(index / belief.width())] +=
        cell == Cell::kOccupied ? '#' : (cell == Cell::kFree ? '.' : '?');
  }
  return rows;
}

constexpr GateRules kAllButGates{0.0, 0.0, 100.0};

/// What is left of a drawing that is ground and belief at once; the robot is at its cell (1, 1).
Rows Closed(const Rows& rows, const GateRules& rules = kAllButGates,
            const Eigen::Vector2i& low = Eigen::Vector2i::Zero()) {
  Belief belief = Drawn(rows, low);
  CloseBesideGates(Drawn(rows, low), low + Eigen::Vector2i(1, 1), rules, belief);
  return RowsOf(belief);
}

TEST(GatesTest, LieBesideGroundThatTheRobotCanGetTo) {
  const Rows rows = {"#########",  //
                     "#...#..?#",  //
                     "#..?#..?#",  //
                     "#########"};
  const Rows closed = {"#########",  //
                       "#...#..##",  //
                       "#..?#..##",  //
                       "#########"};
  EXPECT_EQ(Closed(rows), closed);
  EXPECT_EQ(Closed(rows, kAllButGates, {-7, 5}), closed);
}

TEST(GatesTest, WaysLeadToTheFourSides) {
  const Rows rows = {"######",  //
                     "#..###",  //
                     "###..?",  //
                     "######"};
  const Rows closed = {"######",  //
                       "#..###",  //
                       "###..#",  //
                       "######"};
  EXPECT_EQ(Closed(rows), closed);
}

TEST(GatesTest, WhatLiesBeyondTheMapIsUnknown) {
  const Rows rows = {"#.?###?#",  //
                     "#......#",  //
                     "########"};
  const Rows ground = {"#.######",  // open to what lies beyond
                       "#......#",  //
                       "########"};
  Belief belief = Drawn(rows);
  CloseBesideGates(Drawn(ground), {1, 1}, {0.0, 1.5, 100.0}, belief);
  EXPECT_EQ(RowsOf(belief)[0], "#.?#####");
}

TEST(GatesTest, AroundThemAndFarFromTheFreeTheUnknownStays) {
  const Rows ground = {"##########",  //
                       "#.?#######",  //
                       "##########"};
  const Rows seen = {"##########",  //
                     "#.????????",  //
                     "##########"};
  Belief belief = Drawn(seen);
  CloseBesideGates(Drawn(ground), {1, 1}, {0.0, 2.0, 5.0}, belief);
  EXPECT_EQ(RowsOf(belief)[1], "#.???##???");
}

TEST(GatesTest, LeadToEnoughUnseenGround) {
  const Rows rows = {"########",  //
                     "#?....?#",  //
                     "#.....?#",  //
                     "########"};
  const Rows closed = {"########",  //
                       "##....?#",  //
                       "#.....?#",  //
                       "########"};
  Belief belief = Drawn(rows);
  CloseBesideGates(Drawn(rows), {1, 2}, {2.0, 0.0, 100.0}, belief);
  EXPECT_EQ(RowsOf(belief), closed);
}

TEST(GatesTest, WithoutAnyNothingIsLeft) {
  Belief belief = Drawn({"#####", "#..?#", "#####"});
  CloseBesideGates(Drawn({"#####", "#..##", "#####"}), {1, 1}, {0.0, 50.0, 50.0}, belief);
  EXPECT_EQ(RowsOf(belief), (Rows{"#####", "#..##", "#####"}));
}

}  // namespace
}  // namespace hv::explore
