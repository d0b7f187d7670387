#include "parameters.h"

#include <gtest/gtest.h>

#include "hv_core/error.h"

namespace hv::relocalize {
namespace {

TEST(ParsePose, ReadsPositionAndAngles) {
  const auto pose = ParsePose(" 1 -2.5 3e-1 0 0 1.5707963267948966 ");
  ASSERT_TRUE(pose.has_value());
  EXPECT_TRUE(pose->translation().isApprox(Eigen::Vector3d(1.0, -2.5, 0.3)));
  EXPECT_TRUE((pose->linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
}

TEST(ParsePose, NothingIsNoPose) { EXPECT_FALSE(ParsePose("").has_value()); }

TEST(ParsePose, RefusesEverythingElse) {
  for (const char* text : {"1 2 3", "1 2 3 4 5 6 7", "1 2 3 0 0 north", "1,2,3,0,0,0", "nan"}) {
    EXPECT_THROW(ParsePose(text), InputError) << text;
  }
}

}  // namespace
}  // namespace hv::relocalize
