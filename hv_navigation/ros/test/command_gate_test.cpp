#include "command_gate.h"

#include <vector>

#include <gtest/gtest.h>

namespace hv::navigation {
namespace {

constexpr double kSpeed = 0.5;

int SentWithoutGoal(CommandGate& gate, const Velocity& wanted, int cycles) {
  int sent = 0;
  for (int i = 0; i < cycles; ++i) sent += gate.Next(false, wanted).has_value() ? 1 : 0;
  return sent;
}

TEST(CommandGate, SaysNothingWithoutAGoal) {
  CommandGate gate;
  EXPECT_EQ(SentWithoutGoal(gate, {kSpeed, 0.0}, 10), 0);
}

TEST(CommandGate, PassesAllWhileAGoalIsPursued) {
  CommandGate gate;
  for (const double speed : {0.0, kSpeed, 0.0}) {
    const auto velocity = gate.Next(true, {speed, -speed});
    ASSERT_TRUE(velocity);
    EXPECT_EQ(velocity->linear_mps, speed);
    EXPECT_EQ(velocity->angular_rps, -speed);
  }
}

TEST(CommandGate, BrakesThenSendsAFewZerosThenNothing) {
  CommandGate gate;
  gate.Next(true, {kSpeed, 0.0});
  std::vector<double> sent;
  for (double speed = kSpeed - 0.1; sent.size() < 20; speed = std::max(0.0, speed - 0.1)) {
    const auto velocity = gate.Next(false, {speed, 0.0});
    if (!velocity) break;
    sent.push_back(velocity->linear_mps);
  }
  ASSERT_EQ(sent.size(), 9U);
  EXPECT_NEAR(sent[0], 0.4, 1e-9);
  EXPECT_NEAR(sent[3], 0.1, 1e-9);
  for (std::size_t i = 4; i < sent.size(); ++i) EXPECT_EQ(sent[i], 0.0);
  EXPECT_EQ(SentWithoutGoal(gate, {kSpeed, 0.0}, 10), 0) << "somebody else drives";
}

TEST(CommandGate, AStandingRobotIsNotMovedByAJoystickThatTakesOver) {
  CommandGate gate;
  gate.Next(true, Velocity());
  const auto velocity = gate.Next(false, {kSpeed, 0.0});
  ASSERT_TRUE(velocity);
  EXPECT_EQ(velocity->linear_mps, 0.0);
}

TEST(CommandGate, BrakingEndsThoughTheRobotSlides) {
  CommandGate gate;
  gate.Next(true, {kSpeed, 0.0});
  EXPECT_LT(SentWithoutGoal(gate, {kSpeed, 0.0}, 1000), 50);
}

}  // namespace
}  // namespace hv::navigation
