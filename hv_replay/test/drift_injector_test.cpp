#include "hv_replay/drift_injector.h"

#include <cmath>

#include <gtest/gtest.h>

namespace hv::replay {
namespace {

TEST(DriftInjectorTest, AStraightWayBendsAndStretches) {
  DriftInjector injector({0.01, 0.5});
  Pose drifted = Pose::Identity();
  for (int i = 0; i <= 100; ++i) {
    drifted = injector.Apply(MakePose(Eigen::Matrix3d::Identity(), {0.1 * i, 0.0, 0.0}));
  }
  // An arc of 10.1 m that turns by 5 degrees.
  const double turn = 5.0 * M_PI / 180.0;
  EXPECT_NEAR(std::atan2(drifted.linear()(1, 0), drifted.linear()(0, 0)), turn, 1e-9);
  EXPECT_NEAR(drifted.translation().x(), 10.1 * std::sin(turn) / turn, 0.01);
  EXPECT_NEAR(drifted.translation().y(), 10.1 * (1.0 - std::cos(turn)) / turn, 0.01);
}

TEST(DriftInjectorTest, NothingIsAddedAtRest) {
  DriftInjector injector({0.01, 0.5});
  const Pose start = MakePose(RotationFromRpy(0.1, 0.2, 0.3), {1.0, 2.0, 3.0});
  injector.Apply(start);
  EXPECT_LT((injector.Apply(start).matrix() - start.matrix()).norm(), 1e-12);
}

}  // namespace
}  // namespace hv::replay
