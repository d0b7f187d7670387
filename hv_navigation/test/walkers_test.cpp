#include "hv_navigation/walkers.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace hv::navigation {
namespace {

using Eigen::Vector2d;

const Time kThen = Time::FromSeconds(50.0);

/// Distance between a robot with its margin and a place.
double DistanceTo(const Footprint& footprint, const PlanarPose& robot, const Vector2d& place) {
  const Vector2d there = robot.Inverse() * place;
  const Vector2d margin = Vector2d::Constant(footprint.margin_m);
  const Vector2d most = Vector2d(footprint.front_m, footprint.half_width_m) + margin;
  const Vector2d least = Vector2d(-footprint.back_m, -footprint.half_width_m) - margin;
  return (there - there.cwiseMax(least).cwiseMin(most)).norm();
}

/// The nearest of all places where the walker may be, tried one by one.
double NearestTried(const WalkConfig& config, const Walker& walker, const Footprint& footprint,
                    const PlanarPose& robot, double after_s) {
  double nearest_m = 1e9;
  constexpr int kSpeeds = 400;
  for (int i = 0; i <= kSpeeds; ++i) {
    const double speed_mps = config.least_mps + (config.most_mps - config.least_mps) * i / kSpeeds;
    const Vector2d place = walker.place + speed_mps * after_s * walker.direction;
    nearest_m = std::min(nearest_m, DistanceTo(footprint, robot, place));
  }
  return nearest_m;
}

TEST(WalkersTest, TouchWhereTryingAllSpeedsTouches) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  std::uniform_real_distribution<double> time(0.0, 1.5);
  const WalkConfig config;
  Footprint footprint;
  footprint.front_m = 0.5;
  int touched = 0;
  for (int i = 0; i < 4000; ++i) {
    const double heading = angle(random);
    const double after_s = i % 10 == 0 ? 0.0 : time(random);
    const Walker walker{
        kThen - after_s, {place(random), place(random)}, {std::cos(heading), std::sin(heading)}};
    const PlanarPose robot{{place(random), place(random)}, angle(random)};
    const double nearest_m = NearestTried(config, walker, footprint, robot, after_s);
    if (std::abs(nearest_m - config.radius_m) < 0.005) continue;
    const bool touches = Walkers(config, {walker}).MayTouch(footprint, robot, kThen);
    EXPECT_EQ(touches, nearest_m < config.radius_m) << nearest_m;
    touched += touches ? 1 : 0;
  }
  EXPECT_GT(touched, 500);
  EXPECT_LT(touched, 3500);
}

TEST(WalkersTest, AnyOfThemCounts) {
  const Walker far{kThen, {5.0, 0.0}, {1.0, 0.0}};
  const Walker near{kThen, {0.5, 0.0}, {0.0, 1.0}};
  EXPECT_FALSE(Walkers({}, {}).MayTouch({}, {}, kThen));
  EXPECT_FALSE(Walkers({}, {far}).MayTouch({}, {}, kThen));
  EXPECT_TRUE(Walkers({}, {far, near}).MayTouch({}, {}, kThen));
  EXPECT_FALSE(Walkers({}, {far, near}).MayTouch({}, {}, kThen + 1.0));
}

TEST(WalkersTest, WhatAppearsMayGoAnyWay) {
  const Walker appeared{kThen, {1.5, 0.0}, Vector2d::Zero()};
  const Walkers walkers({}, {}, {appeared});
  EXPECT_FALSE(walkers.MayReach({}, {}, kThen));
  EXPECT_TRUE(walkers.MayReach({}, {}, kThen + 1.0));
  EXPECT_FALSE(walkers.MayTouch({}, {}, kThen + 1.0)) << "but goes nowhere for certain";
}

TEST(WalkersTest, TimesBeforeTheyWereNoticedAreThatTime) {
  const Walker walker{kThen, {0.0, 0.0}, {1.0, 0.0}};
  EXPECT_TRUE(Walkers({}, {walker}).MayTouch({}, {}, kThen - 2.0));
}

TEST(WalkersTest, ConfigurationNamesAllProblems) {
  WalkConfig config;
  config.least_mps = -1.0;
  config.most_mps = -2.0;
  config.horizon_s = 0.0;
  config.radius_m = 0.0;
  ConfigProblems problems;
  config.Validate(problems);
  EXPECT_EQ(problems.lines().size(), 4U);
}

}  // namespace
}  // namespace hv::navigation
