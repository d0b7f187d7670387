#include "hv_loop_btc/submap_registration.h"

#include <tuple>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "town.h"

namespace hv::loop {
namespace {

class RegistrationTest : public ::testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(RegistrationTest, FindsTheRelativePose) {
  const auto [offset_m, offset_rad] = GetParam();
  const Town town(8);
  std::mt19937 random(2);
  const Pose target_pose = SensorPose(0.0, 0.0, 0.2);
  const Pose source_pose = SensorPose(1.0, 2.0, 1.9, 0.02, 0.03);
  const Submap target = town.SubmapAt(0, target_pose, random);
  const Submap source = town.SubmapAt(1, source_pose, random);
  const Pose truth = target_pose.inverse() * source_pose;
  const Pose guess =
      truth * MakePose(RotationFromRpy(0.02, -0.02, offset_rad), {offset_m, -offset_m, 0.1});
  const RegistrationResult result = SubmapRegistration{RegistrationConfig()}.Align(
      target.points, source.points, source.up, guess);
  EXPECT_TRUE(result.converged);
  EXPECT_LT((result.T_target_source.translation() - truth.translation()).norm(), 0.02);
  EXPECT_LT(RotationDistance(result.T_target_source, truth), 0.004);
  EXPECT_GT(result.fitness, 0.8);
  EXPECT_GT(result.overlap, 0.7);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(result.information);
  EXPECT_GT(solver.eigenvalues()[0], 0.0);
}

INSTANTIATE_TEST_SUITE_P(Guesses, RegistrationTest,
                         ::testing::Values(std::make_tuple(0.0, 0.0), std::make_tuple(0.3, 0.05),
                                           std::make_tuple(-0.4, -0.08)));

TEST(RegistrationTest, AnotherPlaceIsSeenThrough) {
  std::mt19937 random(2);
  const Town here(8);
  const Submap target = here.SubmapAt(0, SensorPose(0.0, 0.0, 0.2), random);
  const Submap same = here.SubmapAt(1, SensorPose(0.0, 0.0, 0.2), random);
  const Submap other = Town(9).SubmapAt(2, SensorPose(0.0, 0.0, 0.2), random);
  const SubmapRegistration registration{RegistrationConfig()};
  const auto align = [&](const Submap& source) {
    return registration.Align(target.points, source.points, source.up, Pose::Identity());
  };
  EXPECT_LT(align(same).seen_through, 0.002);
  EXPECT_GT(align(other).seen_through, 0.005);
}

/// Points on the rectangle between two corners, which agree in one coordinate; 1 cm of noise.
void AddRectangle(const Eigen::Vector3f& low, const Eigen::Vector3f& high, std::mt19937& random,
                  std::vector<Eigen::Vector3f>& points) {
  constexpr float kStep = 0.07F;
  std::normal_distribution<float> noise(0.0F, 0.01F);
  const Eigen::Vector3f size = high - low;
  int thin = 0;
  size.minCoeff(&thin);
  const int u = (thin + 1) % 3;
  const int v = (thin + 2) % 3;
  for (float a = 0.0F; a < size[u]; a += kStep) {
    for (float b = 0.0F; b < size[v]; b += kStep) {
      Eigen::Vector3f point = low;
      point[u] += a;
      point[v] += b;
      point[thin] += noise(random);
      points.push_back(point);
    }
  }
}

TEST(RegistrationTest, TheFarSideOfAWallIsNotTheWall) {
  constexpr float kThickness = 0.12F;
  const Eigen::Vector3f to_source(4.0F, 0.0F, 0.0F);
  std::mt19937 random(5);
  std::vector<Eigen::Vector3f> target;
  std::vector<Eigen::Vector3f> source;
  for (std::vector<Eigen::Vector3f>* cloud : {&target, &source}) {
    AddRectangle({-6.0F, -4.0F, -1.0F}, {8.0F, 4.0F, -1.0F}, random, *cloud);
    AddRectangle({-6.0F, -4.0F, -1.0F}, {8.0F, -4.0F, 2.0F}, random, *cloud);
    AddRectangle({-6.0F, 0.0F, -1.0F}, {-6.0F, 1.5F, 2.0F}, random, *cloud);
    const float face = cloud == &target ? 2.0F : 2.0F + kThickness;
    AddRectangle({face, -4.0F, -1.0F}, {face, 0.0F, 2.0F}, random, *cloud);
    AddRectangle({face, 1.5F, -1.0F}, {face, 4.0F, 2.0F}, random, *cloud);
  }
  for (Eigen::Vector3f& point : source) point -= to_source;
  Pose truth = Pose::Identity();
  truth.translation() = to_source.cast<double>();
  const RegistrationResult result = SubmapRegistration{RegistrationConfig()}.Align(
      target, source, Eigen::Vector3d::UnitZ(), truth);
  EXPECT_LT((result.T_target_source.translation() - truth.translation()).norm(), 0.01);
}

TEST(RegistrationTest, EmptyCloudsAreTotal) {
  std::mt19937 random(2);
  const Submap place = Town(8).SubmapAt(0, SensorPose(0.0, 0.0, 0.0), random);
  const SubmapRegistration registration{RegistrationConfig()};
  EXPECT_EQ(registration.Align(place.points, {}, place.up, Pose::Identity()).fitness, 0.0);
  EXPECT_EQ(registration.Align({}, place.points, place.up, Pose::Identity()).fitness, 0.0);
}

}  // namespace
}  // namespace hv::loop
