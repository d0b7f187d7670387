#include "hv_relocalize_ndt/robust_mixture.h"

#include <cmath>

#include <gtest/gtest.h>

namespace hv::relocalize {
namespace {

struct Expected {
  double resolution_m;
  double d1;
  double d2;
  double d3;
};

class PublishedConstants : public testing::TestWithParam<Expected> {};

TEST_P(PublishedConstants, AreReproduced) {
  const Expected& expected = GetParam();
  const RobustMixture mixture = RobustMixture::For(expected.resolution_m, 0.55);
  EXPECT_NEAR(mixture.d1, expected.d1, 1e-3);
  EXPECT_NEAR(mixture.d2, expected.d2, 1e-3);
  EXPECT_NEAR(mixture.d3, expected.d3, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Resolutions, PublishedConstants,
                         testing::Values(Expected{1.0, -2.217, 0.433, 0.598},
                                         Expected{10.0, -9.010, 0.114, 7.506}));

TEST(RobustMixtureTest, AgreesWithTheMixtureWhereItIsFitted) {
  // At the mean, at one standard deviation and far away the approximation is exact.
  for (const double resolution_m : {0.5, 1.0, 3.0, 5.0, 10.0}) {
    for (const double outlier_share : {0.1, 0.35, 0.55, 0.9}) {
      const RobustMixture mixture = RobustMixture::For(resolution_m, outlier_share);
      const double uniform = outlier_share / std::pow(resolution_m, 3);
      for (const double squared : {0.0, 1.0, 1e6}) {
        const double likelihood = 10.0 * (1.0 - outlier_share) * std::exp(-0.5 * squared) + uniform;
        EXPECT_NEAR(mixture.d1 * std::exp(-0.5 * mixture.d2 * squared) + mixture.d3,
                    -std::log(likelihood), 1e-9)
            << resolution_m << " m, " << outlier_share;
      }
    }
  }
}

}  // namespace
}  // namespace hv::relocalize
