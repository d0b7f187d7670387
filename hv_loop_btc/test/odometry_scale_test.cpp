#include "hv_loop_btc/odometry_scale.h"

#include <gtest/gtest.h>

namespace hv::loop {
namespace {

Pose Turned(double x, double yaw) {
  return MakePose(RotationFromRpy(0.0, 0.0, yaw), {x, 0.0, 0.0});
}

TEST(OdometryScaleTest, LoopsThatAgreeWithOdometryChangeNothing) {
  OdometryScale scale{OdometryEdgeConfig()};
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(scale.Observe(Turned(0.02, 0.002), Turned(0.0, 0.0), 100.0));
  }
  EXPECT_EQ(scale.translation(), 1.0);
  EXPECT_EQ(scale.rotation(), 1.0);
}

TEST(OdometryScaleTest, DriftOfTheHeadingLoosensRotationNotTranslation) {
  OdometryScale scale{OdometryEdgeConfig()};
  for (int i = 0; i < 5; ++i) scale.Observe(Turned(10.0, 0.3), Turned(0.0, 0.0), 100.0);
  EXPECT_GT(scale.rotation(), 10.0);
  EXPECT_EQ(scale.translation(), 1.0);
  GraphEdge edge;
  edge = scale.Scaled(edge);
  EXPECT_NEAR(edge.information(5, 5), 1.0 / (scale.rotation() * scale.rotation()), 1e-12);
  EXPECT_EQ(edge.information(0, 0), 1.0);
}

TEST(OdometryScaleTest, OneFalseLoopAmongGoodOnesDoesNotSetIt) {
  OdometryScale scale{OdometryEdgeConfig()};
  for (int i = 0; i < 9; ++i) scale.Observe(Turned(0.0, 0.0), Turned(0.0, 0.0), 50.0);
  EXPECT_FALSE(scale.Observe(Turned(20.0, 1.0), Turned(0.0, 0.0), 50.0));
}

}  // namespace
}  // namespace hv::loop
