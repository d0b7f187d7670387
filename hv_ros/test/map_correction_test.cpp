#include "hv_ros/map_correction.h"

#include <gtest/gtest.h>

namespace hv {
namespace {

const Pose kBody = MakePose(RotationFromRpy(0.0, 0.0, 0.4), Eigen::Vector3d(120.0, -40.0, 1.0));
const Pose kCorrection = MakePose(RotationFromRpy(0.01, 0.0, 0.1), Eigen::Vector3d(2.0, 1.0, -0.3));

Time At(double seconds) { return Time::FromSeconds(1000.0 + seconds); }

TEST(MapCorrection, IsTheIdentityUntilTold) {
  MapCorrection correction(1.0);
  EXPECT_TRUE(correction.At(At(0.0), kBody).isApprox(Pose::Identity(), 0.0));
}

TEST(MapCorrection, ReachesTheNewValueInTimeWithoutJumps) {
  MapCorrection correction(1.0);
  correction.At(At(0.0), kBody);
  correction.MoveTo(kCorrection);
  const Pose end = kCorrection * kBody;
  Pose before = kBody;
  double way = 0.0;
  for (int i = 0; i <= 10; ++i) {
    const Pose body = correction.At(At(0.1 * i), kBody) * kBody;
    way += (body.translation() - before.translation()).norm();
    EXPECT_LT((body.translation() - before.translation()).norm(),
              0.11 * (end.translation() - kBody.translation()).norm());
    EXPECT_LT(RotationDistance(body, before), 0.011);
    before = body;
  }
  EXPECT_NEAR(way, (end.translation() - kBody.translation()).norm(), 1e-6);
  EXPECT_TRUE(correction.At(At(1.0), kBody).isApprox(kCorrection, 0.0));
}

TEST(MapCorrection, ANewValueOnTheWayStartsFromWhereItIs) {
  MapCorrection correction(1.0);
  correction.MoveTo(kCorrection);
  correction.At(At(0.0), kBody);
  const Pose halfway = correction.At(At(0.5), kBody);
  correction.MoveTo(Pose::Identity());
  EXPECT_TRUE(correction.At(At(0.5), kBody).isApprox(halfway, 1e-12));
  EXPECT_TRUE(correction.At(At(1.5), kBody).isApprox(Pose::Identity(), 1e-12));
}

TEST(MapCorrection, JumpsWhereToldTo) {
  MapCorrection correction(1.0);
  correction.JumpTo(kCorrection);
  EXPECT_TRUE(correction.At(At(0.0), kBody).isApprox(kCorrection, 0.0));
  MapCorrection immediate(0.0);
  immediate.MoveTo(kCorrection);
  EXPECT_TRUE(immediate.At(At(0.0), kBody).isApprox(kCorrection, 0.0));
}

TEST(MapCorrection, AClockThatJumpsBackEndsTheMovement) {
  MapCorrection correction(1.0);
  correction.MoveTo(kCorrection);
  correction.At(At(0.0), kBody);
  EXPECT_TRUE(correction.At(At(-500.0), kBody).isApprox(kCorrection, 0.0));
}

}  // namespace
}  // namespace hv
