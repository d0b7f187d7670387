#include "hv_lio/moving_start.h"

#include <gtest/gtest.h>

#include "random_state.h"

namespace hv::lio {
namespace {

TEST(MovingStartTest, CarryBackUndoesThePropagation) {
  std::mt19937 random(3);
  for (const ImuQuality quality : {ImuQuality::kMeasured, ImuQuality::kMissing}) {
    const NavState start = RandomState(random);
    std::vector<ImuStep> steps(200);
    NavState end = start;
    for (ImuStep& step : steps) {
      step.angular_velocity = RandomVector(random, 1.5);
      step.acceleration = RandomVector(random, 8.0);
      step.dt = 0.005;
      step.quality = quality;
      PropagateState(step, end);
    }
    EXPECT_GT(end.Minus(start).norm(), 0.5);
    EXPECT_LT(CarryBack(end, steps).Minus(start).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace hv::lio
