#include "pose_message.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace hv::relocalize {
namespace {

geometry_msgs::PoseWithCovariance Clicked(double x_variance, double yaw_variance) {
  geometry_msgs::PoseWithCovariance message;
  message.pose.position.x = 3.0;
  message.pose.orientation.w = 1.0;
  message.covariance[0] = x_variance;
  message.covariance[35] = yaw_variance;
  return message;
}

TEST(GuessFromTest, ReachesAsFarAsTheMessageDoubts) {
  RelocalizeConfig least;
  least.guess_radius_m = 1.0;
  const PoseGuess guess = GuessFrom(Clicked(4.0, 0.25), least);
  EXPECT_EQ(guess.T_map_scan.translation().x(), 3.0);
  EXPECT_DOUBLE_EQ(guess.radius_m, 6.0);
  EXPECT_DOUBLE_EQ(guess.heading_rad, 1.5);
  EXPECT_DOUBLE_EQ(GuessFrom(Clicked(0.0, 100.0), least).heading_rad, M_PI);
}

TEST(GuessFromTest, ReachesAsFarAsConfiguredAtLeast) {
  const RelocalizeConfig config;
  for (const double variance : {0.0, 1e-6, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const PoseGuess guess = GuessFrom(Clicked(variance, variance), config);
    EXPECT_DOUBLE_EQ(guess.radius_m, config.guess_radius_m);
    EXPECT_DOUBLE_EQ(guess.heading_rad, config.guess_heading_deg * M_PI / 180.0);
  }
}

}  // namespace
}  // namespace hv::relocalize
