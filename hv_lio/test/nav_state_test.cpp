#include "hv_lio/nav_state.h"

#include <random>

#include <gtest/gtest.h>

#include "hv_core/so3.h"
#include "random_state.h"

namespace hv::lio {
namespace {

class NavStateTest : public ::testing::TestWithParam<double> {};

TEST_P(NavStateTest, PlusAndMinusAreInverse) {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const NavState state = RandomState(random);
    const ErrorVector delta = GetParam() * RandomError(random);
    EXPECT_LT((state.Plus(delta).Minus(state) - delta).norm(), 1e-9);
    const NavState other = state.Plus(delta);
    EXPECT_LT(other.Minus(state.Plus(other.Minus(state))).norm(), 1e-9);
    EXPECT_NEAR(other.gravity.norm(), state.gravity.norm(), 1e-9);
  }
}

TEST_P(NavStateTest, MinusJacobianMatchesDifferences) {
  std::mt19937 random(2);
  for (int i = 0; i < 20; ++i) {
    const NavState prior = RandomState(random);
    const NavState current = prior.Plus(GetParam() * RandomError(random));
    const ErrorMatrix jacobian = current.MinusJacobian(prior);
    for (int column = 0; column < kErrorDim; ++column) {
      const ErrorVector step = 1e-6 * ErrorVector::Unit(column);
      const ErrorVector numeric =
          (current.Plus(step).Minus(prior) - current.Plus(-step).Minus(prior)) / 2e-6;
      EXPECT_LT((jacobian.col(column) - numeric).norm(), 1e-6) << "column " << column;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, NavStateTest, ::testing::Values(0.0, 1e-7, 1e-2, 0.5));

TEST(TangentBasisTest, IsOrthonormalAndPerpendicular) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d direction(normal(random), normal(random), normal(random));
    const Eigen::Matrix<double, 3, 2> basis = TangentBasis(direction);
    EXPECT_LT((basis.transpose() * basis - Eigen::Matrix2d::Identity()).norm(), 1e-12);
    EXPECT_LT((basis.transpose() * direction).norm(), 1e-12 * direction.norm() + 1e-15);
  }
}

}  // namespace
}  // namespace hv::lio
