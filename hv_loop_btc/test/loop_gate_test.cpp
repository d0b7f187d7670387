#include "hv_loop_btc/loop_gate.h"

#include <gtest/gtest.h>

namespace hv::loop {
namespace {

Pose At(double x, double z, double yaw, double pitch = 0.0) {
  return MakePose(RotationFromRpy(0.0, pitch, yaw), {x, 0.0, z});
}

TEST(LoopGateTest, LimitsGrowWithTheWay) {
  const LoopGate gate{LoopGateConfig()};
  DriftLimits before = gate.LimitsAfter(0.0);
  EXPECT_EQ(before.translation_m, LoopGateConfig().base_translation_m);
  for (const double travelled : {10.0, 50.0, 200.0, 1000.0}) {
    const DriftLimits after = gate.LimitsAfter(travelled);
    EXPECT_GT(after.translation_m, before.translation_m);
    EXPECT_GT(after.vertical_m, before.vertical_m);
    EXPECT_GE(after.rotation_rad, before.rotation_rad);
    EXPECT_EQ(after.tilt_rad, before.tilt_rad);
    EXPECT_LT(after.translation_m, 1.2 * travelled + LoopGateConfig().base_translation_m);
    before = after;
  }
}

TEST(LoopGateTest, OtherPlacesFloorsHeadingsAndTiltsAreRefused) {
  const DriftLimits limits = LoopGate{LoopGateConfig()}.LimitsAfter(10.0);
  const Pose predicted = At(1.0, 0.0, 0.5);
  EXPECT_TRUE(LoopGate::Allows(predicted, predicted, limits));
  EXPECT_TRUE(LoopGate::Allows(At(1.5, 0.1, 0.55, 0.02), predicted, limits));
  EXPECT_FALSE(LoopGate::Allows(At(5.0, 0.0, 0.5), predicted, limits));
  EXPECT_FALSE(LoopGate::Allows(At(1.0, 3.0, 0.5), predicted, limits));
  EXPECT_FALSE(LoopGate::Allows(At(1.0, 0.0, 0.5 + M_PI), predicted, limits));
  EXPECT_FALSE(LoopGate::Allows(At(1.0, 0.0, 0.5, 0.15), predicted, limits));
}

}  // namespace
}  // namespace hv::loop
