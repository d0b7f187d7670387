#include "hv_explore_sac/bounds.h"

#include <cmath>

#include <gtest/gtest.h>

namespace hv::explore {
namespace {

TEST(BoundsTest, NoneHoldEverything) {
  EXPECT_TRUE(Bounds().Contains({1e6, -3.0}));
  EXPECT_EQ(Bounds().Problem(), "");
}

TEST(BoundsTest, HoldWhatLiesInsideWhicheverWayRound) {
  const std::vector<Eigen::Vector2d> corners = {{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}};
  for (const Bounds& bounds :
       {Bounds(corners), Bounds(std::vector<Eigen::Vector2d>(corners.rbegin(), corners.rend()))}) {
    EXPECT_EQ(bounds.Problem(), "");
    EXPECT_TRUE(bounds.Contains({0.5, 2.0}));
    EXPECT_TRUE(bounds.Contains({3.5, 2.0}));
    EXPECT_FALSE(bounds.Contains({2.0, 2.0}));  // in the notch
    EXPECT_FALSE(bounds.Contains({5.0, 1.0}));
    EXPECT_FALSE(bounds.Contains({2.0, -0.1}));
  }
}

TEST(BoundsTest, TellWhatIsWrong) {
  const auto problem = [](std::vector<Eigen::Vector2d> corners) {
    return Bounds(std::move(corners)).Problem();
  };
  EXPECT_NE(problem({{0, 0}, {4, 0}}).find("fewer than three"), std::string::npos);
  EXPECT_NE(problem({{0, 0}, {NAN, 0}, {1, 1}}).find("not finite"), std::string::npos);
  EXPECT_NE(problem({{0, 0}, {1e9, 0}, {1, 1}}).find("too far"), std::string::npos);
  EXPECT_NE(problem({{0, 0}, {4, 4}, {4, 0}, {0, 4}}).find("cross"), std::string::npos);
  EXPECT_NE(problem({{0, 0}, {1, 0}, {1, 1}}).find("less than 1 m^2"), std::string::npos);
}

}  // namespace
}  // namespace hv::explore
