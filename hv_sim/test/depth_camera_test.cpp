#include "hv_sim/depth_camera.h"

#include <cmath>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "hv_core/error.h"
#include "hv_sim/mesh_builder.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

DepthCameraConfig ExactCamera() {
  DepthCameraConfig config;
  config.noise = false;
  return config;
}

/// A wall at x = `distance` in front of a camera at the origin that looks along x.
MeshBuilder Wall(double distance) {
  MeshBuilder builder;
  builder.AddQuad({distance, -40.0, -40.0}, {0.0, 80.0, 0.0}, {0.0, 0.0, 80.0}, 10.0);
  return builder;
}

DepthImage Capture(const DepthCameraConfig& config, const MeshBuilder& builder,
                   const Pose& T_world_camera = Pose::Identity()) {
  return DepthCamera(config, 3).Capture(RayCaster(builder.mesh()), {}, T_world_camera, 1.0);
}

/// Point of a pixel in the camera frame, as a user of the image would compute it.
Vector3d PointOf(const DepthImage& image, const DepthCameraConfig& config, int column, int row) {
  const double depth = 1e-3 * image.depth_mm[static_cast<std::size_t>(row * image.width + column)];
  const Vector3d optical((column - config.cx()) / config.fx() * depth,
                         (row - config.cy()) / config.fy() * depth, depth);
  return OpticalInCamera() * optical;
}

TEST(DepthCameraTest, DepthOfAWallIsItsDistanceEverywhere) {
  for (const double distance : {0.5, 2.0, 7.5}) {
    const DepthImage image = Capture(ExactCamera(), Wall(distance));
    ASSERT_EQ(image.depth_mm.size(), 212U * 120U);
    for (const std::uint16_t depth : image.depth_mm) {
      ASSERT_EQ(depth, static_cast<std::uint16_t>(std::lround(1000.0 * distance)));
    }
  }
}

TEST(DepthCameraTest, PointsOfATiltedCameraLieOnThePlane) {
  const Vector3d normal = Vector3d(1.0, 0.4, -0.3).normalized();
  const Eigen::Matrix3d axes =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), normal).toRotationMatrix();
  MeshBuilder builder;
  builder.AddQuad(2.5 * normal - 30.0 * axes.col(0) - 30.0 * axes.col(1), 60.0 * axes.col(0),
                  60.0 * axes.col(1), 10.0);
  const DepthCameraConfig config = ExactCamera();
  const Pose T_world_camera = MakePose(RotationFromRpy(0.1, 0.2, 0.3), Vector3d(0.2, -0.1, 0.3));
  const DepthImage image = Capture(config, builder, T_world_camera);
  double worst = 0.0;
  int seen = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const Vector3d point = PointOf(image, config, column, row);
      if (point.norm() == 0.0) continue;
      worst = std::max(worst, std::abs(normal.dot(T_world_camera * point) - 2.5));
      ++seen;
    }
  }
  EXPECT_GT(seen, 20000);
  EXPECT_LT(worst, 0.5e-3 * 1.5);  // half a step of the depth, more off the axis
}

TEST(DepthCameraTest, TheFieldOfViewIsThatOfTheCamera) {
  // A wall ends at the border of the view: the outermost pixels look half a pixel inside.
  const DepthCameraConfig config = ExactCamera();
  EXPECT_NEAR(std::atan((config.cx() + 0.5) / config.fx()) * 360.0 / M_PI, 87.0, 1e-9);
  EXPECT_NEAR(std::atan((config.cy() + 0.5) / config.fy()) * 360.0 / M_PI, 58.0, 1e-9);
  MeshBuilder left;
  left.AddBox(Pose::Identity(), Vector3d(1.0, 0.5, -0.1), Vector3d(1.1, 0.6, 0.1));
  const DepthImage image = Capture(config, left);
  for (int row = 0; row < image.height; ++row) {
    for (int column = 106; column < image.width; ++column) {
      EXPECT_EQ(image.depth_mm[static_cast<std::size_t>(row * image.width + column)], 0);
    }
  }
  EXPECT_NEAR(PointOf(image, config, 45, 60).y(), 0.54, 0.06);
}

TEST(DepthCameraTest, NothingIsSeenOutsideOfItsRange) {
  for (const double distance : {0.2, 10.5}) {
    for (const std::uint16_t depth : Capture(ExactCamera(), Wall(distance)).depth_mm) {
      ASSERT_EQ(depth, 0);
    }
  }
}

TEST(DepthCameraTest, NoiseGrowsWithTheSquareOfTheDepth) {
  const DepthCameraConfig config;
  for (const double distance : {1.0, 2.0, 4.0}) {
    double square = 0.0;
    double sum = 0.0;
    int count = 0;
    for (const std::uint16_t depth : Capture(config, Wall(distance)).depth_mm) {
      if (depth == 0) continue;
      sum += 1e-3 * depth - distance;
      square += std::pow(1e-3 * depth - distance, 2);
      ++count;
    }
    EXPECT_GT(count, 25000);
    EXPECT_NEAR(std::sqrt(square / count) / (0.005 * distance * distance), 1.0, 0.03);
    EXPECT_NEAR(sum / count, 0.0, 5.0 * 0.005 * distance * distance / std::sqrt(count));
  }
}

TEST(DepthCameraTest, EdgesAndGrazedSurfacesHaveHoles) {
  MeshBuilder builder = Wall(4.0);
  builder.AddQuad({1.0, -0.5, -0.5}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0});
  const DepthCameraConfig config;
  const DepthImage image = Capture(config, builder);
  const DepthImage exact = Capture(ExactCamera(), builder);
  int edges = 0;
  int lost_edges = 0;
  int lost_elsewhere = 0;
  for (int row = 1; row + 1 < image.height; ++row) {
    for (int column = 1; column + 1 < image.width; ++column) {
      const auto at = static_cast<std::size_t>(row * image.width + column);
      const auto width = static_cast<std::size_t>(image.width);
      const bool edge = exact.depth_mm[at] != exact.depth_mm[at + 1] ||
                        exact.depth_mm[at] != exact.depth_mm[at - 1] ||
                        exact.depth_mm[at] != exact.depth_mm[at + width] ||
                        exact.depth_mm[at] != exact.depth_mm[at - width];
      edges += edge ? 1 : 0;
      lost_edges += edge && image.depth_mm[at] == 0 ? 1 : 0;
      lost_elsewhere += !edge && image.depth_mm[at] == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(edges, 600);
  EXPECT_NEAR(static_cast<double>(lost_edges) / edges, config.edge_loss, 0.08);
  EXPECT_EQ(lost_elsewhere, 0);

  // A floor 5 cm below is seen edge-on: beyond a metre at less than 0.05 rad.
  MeshBuilder floor;
  floor.AddQuad({0.0, -30.0, -0.05}, {60.0, 0.0, 0.0}, {0.0, 60.0, 0.0}, 10.0);
  for (const std::uint16_t depth : Capture(config, floor).depth_mm) EXPECT_LT(depth, 1050);
}

TEST(DepthCameraTest, PeopleAreSeenWhereTheyAre) {
  PersonPath path;
  path.waypoints = {{3.0, -10.0, -1.0}, {3.0, 10.0, -1.0}};
  path.speed = 1.0;
  const DepthCamera camera(ExactCamera(), 1);
  const RayCaster scene(Wall(6.0).mesh());
  const auto nearest_at = [&](double time_s) {
    const DepthImage image = camera.Capture(scene, {path}, Pose::Identity(), time_s);
    return *std::min_element(image.depth_mm.begin(), image.depth_mm.end());
  };
  EXPECT_NEAR(nearest_at(10.0), 2800, 150);
  EXPECT_EQ(nearest_at(1.0), 6000);
}

TEST(DepthCameraTest, TheSeedDecidesWhateverTheNumberOfThreads) {
  MeshBuilder builder = Wall(4.0);
  builder.AddQuad({1.0, -0.5, -0.5}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0});
  const RayCaster scene(builder.mesh());
  const auto capture = [&](std::uint32_t seed, std::size_t threads, double time_s) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return DepthCamera({}, seed).Capture(scene, {}, Pose::Identity(), time_s).depth_mm;
  };
  EXPECT_EQ(capture(1, 1, 2.0), capture(1, 4, 2.0));
  EXPECT_NE(capture(1, 1, 2.0), capture(2, 1, 2.0));
  EXPECT_NE(capture(1, 1, 2.0), capture(1, 1, 2.1));
}

TEST(DepthCameraTest, LowThingsAheadOfTheRobotAreInView) {
  // 0.15 m high, from 0.5 to 3 m ahead of the front of the robot.
  const DepthCameraConfig config = ExactCamera();
  const Pose T_base_camera = config.mounting();
  const double pitch_deg = std::asin(-T_base_camera.linear()(2, 0)) * 180.0 / M_PI;
  EXPECT_NEAR(pitch_deg, 17.5, 0.01);
  for (const double ahead : {0.5, 1.0, 2.0, 3.0}) {
    MeshBuilder builder;
    builder.AddBox(Pose::Identity(), Vector3d(0.3 + ahead, -0.1, 0.0),
                   Vector3d(0.4 + ahead, 0.1, 0.15));
    const DepthImage image = Capture(config, builder, T_base_camera);
    const auto seen =
        std::count_if(image.depth_mm.begin(), image.depth_mm.end(), [](int mm) { return mm > 0; });
    EXPECT_GT(seen, 25) << ahead;
  }
}

TEST(DepthCameraTest, ConfigurationIsChecked) {
  DepthCameraConfig config;
  config.width = 0;
  config.max_depth_m = 0.1;
  config.T_base_camera = {1.0};
  ConfigProblems problems;
  config.Validate(problems);
  EXPECT_EQ(problems.lines().size(), 3U);
  EXPECT_THROW(DepthCamera(config, 1), InputError);
}

}  // namespace
}  // namespace hv::sim
