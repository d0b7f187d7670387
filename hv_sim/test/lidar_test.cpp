#include "hv_sim/lidar.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "hv_core/angles.h"
#include "hv_core/error.h"
#include "hv_core/so3.h"
#include "hv_sim/mesh_builder.h"
#include "hv_sim/pedestrian.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

/// Fast and twisted: several rad/s and m/s with strong accelerations.
Pose FastPose(double time) {
  const Vector3d position(0.8 * std::sin(2.1 * time), 0.7 * std::cos(3.3 * time),
                          1.4 + 0.2 * std::sin(5.0 * time));
  const Eigen::Matrix3d rotation = so3::Exp(Vector3d(0.3 * std::sin(6.0 * time), 0.0, 0.0)) *
                                   so3::Exp(Vector3d(0.0, 0.25 * std::cos(4.0 * time), 0.0)) *
                                   so3::Exp(Vector3d(0.0, 0.0, 4.0 * time));
  return MakePose(rotation, position);
}

Pose StillPose(double /*time*/) { return Pose(Eigen::Translation3d(0.0, 0.0, 1.2)); }

/// A room of 10 x 8 x 3 m around the origin, floor at z = 0, with a tilted box and a ball in it.
World Room() {
  World world;
  world.name = "room";
  MeshBuilder mesh;
  mesh.SetReflectivity(0.6);
  mesh.AddBox(Upright({0.0, 0.0, 1.5}), Vector3d(10.0, 8.0, 3.0));
  mesh.AddBox(MakePose(RotationFromRpy(0.3, 0.5, 0.7), Vector3d(3.0, 2.0, 0.8)),
              Vector3d(0.8, 0.6, 1.0));
  mesh.AddEllipsoid(Upright({-3.0, 1.5, 1.0}), {0.6, 0.6, 0.6}, 0.0, 1);
  world.mesh = mesh.mesh();
  return world;
}

/// One wall at x = `distance`, nothing else.
World WallAt(double distance, double reflectivity) {
  World world;
  MeshBuilder mesh;
  mesh.SetReflectivity(reflectivity);
  mesh.AddQuad({distance, -50.0, -50.0}, {0.0, 100.0, 0.0}, {0.0, 0.0, 100.0}, 10.0);
  world.mesh = mesh.mesh();
  return world;
}

LidarOptions Exact() {
  LidarOptions options;
  options.noise = false;
  return options;
}

Vector3d Position(const Point& point) {
  return {static_cast<double>(point.x), static_cast<double>(point.y), static_cast<double>(point.z)};
}

bool Same(const Scan& a, const Scan& b) {
  const auto same_point = [](const Point& p, const Point& q) {
    return p.x == q.x && p.y == q.y && p.z == q.z && p.intensity == q.intensity &&
           p.time == q.time && p.ring == q.ring;
  };
  return a.stamp == b.stamp && a.duration == b.duration &&
         std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), same_point);
}

class EveryModel : public testing::TestWithParam<LidarModel> {};

TEST_P(EveryModel, UndistortedPointsLieOnTheSurfaces) {
  const LidarSimulator lidar(Room(), GetParam(), Exact(), 1);
  constexpr double kStart = 12.3;
  const Scan scan = lidar.Sweep(kStart, FastPose);
  // Every ray ends on a wall of the closed room.
  EXPECT_EQ(scan.points.size(), static_cast<std::size_t>(GetParam().columns) * 32U);
  double worst = 0.0;
  for (const Point& point : scan.points) {
    const Vector3d in_world = FastPose(kStart + static_cast<double>(point.time)) * Position(point);
    worst = std::max(worst, lidar.DistanceToSurface(in_world, 1.0));
  }
  EXPECT_LT(worst, 1e-4);
}

TEST_P(EveryModel, RaysStartAtThePoseOfTheirOwnFiring) {
  // Compares with the pose evaluated at each firing, though the simulator evaluates it once a
  // column. What remains below a micrometre is single precision.
  constexpr double kDistance = 2.5;
  const LidarModel& model = GetParam();
  const LidarSimulator lidar(WallAt(kDistance, 0.9), model, Exact(), 1);
  double worst = 0.0;
  int count = 0;
  for (const Point& point : lidar.Sweep(0.0, FastPose).points) {
    const double time = static_cast<double>(point.time);
    const auto column = static_cast<int>((time + 1e-7) / model.column_period);
    // Float holds the time to nanoseconds only; the exact firing time follows from the column.
    const double fired = column * model.column_period + model.firing_delay[point.ring];
    ASSERT_NEAR(time, fired, 1e-8);
    const Pose pose = FastPose(fired);
    const Vector3d axis = model.Direction(column, point.ring);
    const double range = (kDistance - pose.translation().x()) / (pose.linear() * axis).x();
    if (range > 4.0) continue;
    worst = std::max(worst, (Position(point) - range * axis).norm());
    ++count;
  }
  ASSERT_GT(count, 5000);
  EXPECT_LT(worst, 1e-6);
}

TEST_P(EveryModel, FiresInOrderAndOnTime) {
  const LidarModel& model = GetParam();
  const LidarSimulator lidar(Room(), model, Exact(), 1);
  const Scan scan = lidar.Sweep(5.0, StillPose);
  ASSERT_EQ(scan.points.size(), static_cast<std::size_t>(model.columns) * 32U);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Point& point = scan.points[i];
    const double expected =
        static_cast<double>(i / 32) * model.column_period + model.firing_delay[i % 32];
    ASSERT_EQ(point.ring, i % 32);
    ASSERT_NEAR(static_cast<double>(point.time), expected, 1e-8);
    ASSERT_TRUE(i == 0 || point.time > scan.points[i - 1].time);
  }
  EXPECT_EQ(scan.stamp, Time::FromSeconds(5.0));
  EXPECT_EQ(scan.duration, static_cast<double>(scan.points.back().time));
  EXPECT_LT(scan.duration, model.period());
}

TEST_P(EveryModel, ChannelsKeepTheirElevation) {
  const LidarModel& model = GetParam();
  const LidarSimulator lidar(Room(), model, Exact(), 1);
  for (const Point& point : lidar.Sweep(0.0, StillPose).points) {
    const Vector3d at = Position(point);
    ASSERT_NEAR(std::asin(at.z() / at.norm()), model.elevation[point.ring], 1e-6);
  }
}

TEST_P(EveryModel, SpinsClockwise) {
  const LidarSimulator lidar(Room(), GetParam(), Exact(), 1);
  const Scan scan = lidar.Sweep(0.0, StillPose);
  const Vector3d first = Position(scan.points[0]);
  const Vector3d later = Position(scan.points[32U * 100U]);
  EXPECT_LT(first.cross(later).z(), 0.0);
}

TEST_P(EveryModel, ResultDoesNotDependOnThreads) {
  LidarOptions options;
  options.dropout = 0.1;
  World world = Room();
  world.people = {{{{-2.0, -2.0, 0.0}, {2.0, -2.0, 0.0}}, 1.2, 0.0}};
  const LidarSimulator lidar(world, GetParam(), options, 7);
  const auto sweep = [&lidar](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return lidar.Sweep(1.5, FastPose);
  };
  const Scan one = sweep(1);
  EXPECT_TRUE(Same(one, sweep(2)));
  EXPECT_TRUE(Same(one, sweep(4)));
  const LidarSimulator other_seed(world, GetParam(), options, 8);
  EXPECT_FALSE(Same(one, other_seed.Sweep(1.5, FastPose)));
  EXPECT_FALSE(Same(one, lidar.Sweep(1.6, FastPose)));
}

INSTANTIATE_TEST_SUITE_P(Models, EveryModel, testing::Values(PandarXt32(), Hdl32e()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(PandarXt32, MatchesARealUnit) {
  const LidarModel model = PandarXt32();
  // Facts read off the packets and the calibration sheet of a real PandarXT-32 at 10 Hz: azimuths
  // advance by 0.18 degrees, 2000 a turn of 100.0 ms; 0 degrees is y and grows towards x; channels
  // 1, 16 and 32 look up by 14.97, -0.05 and -16.02 degrees and ahead by 0.082, -0.015 and -0.130.
  EXPECT_EQ(model.columns, 2000);
  EXPECT_NEAR(model.period(), 0.1, 1e-9);
  const auto azimuth = [&model](int column, std::size_t channel) {
    const Vector3d direction = model.Direction(column, channel);
    return std::atan2(direction.x(), direction.y()) / kRadiansPerDegree;
  };
  EXPECT_NEAR(azimuth(0, 0), 0.082, 0.02);
  EXPECT_NEAR(azimuth(0, 15), -0.015, 0.02);
  EXPECT_NEAR(azimuth(0, 31), -0.130, 0.02);
  EXPECT_NEAR(azimuth(100, 15) - azimuth(0, 15), 18.0, 1e-9);
  EXPECT_NEAR(model.elevation[0] / kRadiansPerDegree, 14.97, 0.1);
  EXPECT_NEAR(model.elevation[15] / kRadiansPerDegree, -0.05, 0.1);
  EXPECT_NEAR(model.elevation[31] / kRadiansPerDegree, -16.02, 0.1);
}

TEST(PandarXt32, ChannelsFireOnTheDataSheetsTimes) {
  const LidarModel model = PandarXt32();
  for (std::size_t channel = 1; channel <= 32; ++channel) {
    EXPECT_NEAR(model.firing_delay[channel - 1],
                (0.368 + 1.512 * (static_cast<double>(channel) - 1.0)) * 1e-6, 1e-12);
  }
}

TEST(Hdl32e, FiresItsTwoBanksInTurn) {
  const LidarModel model = Hdl32e();
  // The first and last lasers of the manual's firing order, in degrees.
  EXPECT_NEAR(model.elevation[0] / kRadiansPerDegree, -30.67, 0.01);
  EXPECT_NEAR(model.elevation[1] / kRadiansPerDegree, -9.33, 0.01);
  EXPECT_NEAR(model.elevation[2] / kRadiansPerDegree, -29.33, 0.01);
  EXPECT_NEAR(model.elevation[15] / kRadiansPerDegree, 0.0, 0.01);
  EXPECT_NEAR(model.elevation[30] / kRadiansPerDegree, -10.67, 0.01);
  EXPECT_NEAR(model.elevation[31] / kRadiansPerDegree, 10.67, 0.01);
  EXPECT_NEAR(model.column_period, 46.08e-6, 1e-12);
  EXPECT_NEAR(model.period(), 0.1, 1e-4);
}

TEST(Noise, RangeHasTheModelsSigmaAndNoBias) {
  constexpr double kDistance = 8.0;
  LidarModel model = PandarXt32();
  const LidarSimulator lidar(WallAt(kDistance, 0.8), model, {}, 3);
  const Pose ahead = Pose::Identity();
  double sum = 0.0;
  double squares = 0.0;
  int count = 0;
  for (int sweep = 0; sweep < 5; ++sweep) {
    for (const Point& point : lidar.Sweep(sweep, [&](double) { return ahead; }).points) {
      const Vector3d at = Position(point);
      const double range = at.norm();
      if (at.x() < 0.9 * range) continue;  // near the normal, where the footprint is small
      const double error = range - kDistance * range / at.x();
      sum += error;
      squares += error * error;
      ++count;
    }
  }
  ASSERT_GT(count, 10000);
  const double mean = sum / count;
  EXPECT_NEAR(mean, 0.0, 5e-4);
  EXPECT_NEAR(std::sqrt(squares / count - mean * mean), model.range_sigma, 5e-4);
}

TEST(Noise, EdgesMixOrChooseBetweenTwoSurfaces) {
  // A near plate in front of a wall. Closer than the pulse is long: some ranges in between. Further
  // apart: each range belongs to one of the two.
  const auto between = [](double gap) {
    MeshBuilder mesh;
    mesh.SetReflectivity(0.8);
    mesh.AddQuad({10.0, -50.0, -50.0}, {0.0, 100.0, 0.0}, {0.0, 0.0, 100.0}, 10.0);
    mesh.AddQuad({10.0 - gap, 0.0, -50.0}, {0.0, 50.0, 0.0}, {0.0, 0.0, 100.0}, 10.0);
    World world;
    world.mesh = mesh.mesh();
    LidarModel model = PandarXt32();
    model.range_sigma = 1e-6;
    const LidarSimulator lidar(world, model, {}, 1);
    int mixed = 0;
    for (const Point& point : lidar.Sweep(0.0, [](double) { return Pose::Identity(); }).points) {
      const double x = static_cast<double>(point.x);
      if (std::abs(point.y) > 0.1F) continue;
      if (x < 10.0 - 0.2 * gap && x > 10.0 - 0.8 * gap) ++mixed;
    }
    return mixed;
  };
  EXPECT_GT(between(0.2), 5);
  EXPECT_EQ(between(2.0), 0);
}

TEST(Range, DependsOnReflectivityAndMaximum) {
  const auto returns = [](double distance, double reflectivity) {
    const LidarSimulator lidar(WallAt(distance, reflectivity), PandarXt32(), Exact(), 1);
    return lidar.Sweep(0.0, [](double) { return Pose::Identity(); }).points.size();
  };
  EXPECT_GT(returns(75.0, 0.1), 0U);
  EXPECT_EQ(returns(85.0, 0.1), 0U);
  EXPECT_GT(returns(115.0, 0.9), 0U);
  EXPECT_EQ(returns(125.0, 0.9), 0U);
  // Grazing rays fade first: the share of the half turn that returns shrinks with distance.
  EXPECT_LT(returns(60.0, 0.3), returns(20.0, 0.3));
}

TEST(Options, DropoutAndAzimuthKeepThinTheScan) {
  LidarOptions options = Exact();
  const auto count = [&options] {
    return static_cast<double>(
        LidarSimulator(Room(), PandarXt32(), options, 1).Sweep(0.0, StillPose).points.size());
  };
  const double all = count();
  options.dropout = 0.25;
  EXPECT_NEAR(count() / all, 0.75, 0.01);
  options.dropout = 0.0;
  options.azimuth_keep = 0.3;
  EXPECT_NEAR(count() / all, 0.3, 0.001);
}

TEST(Model, ListsOfUnequalLengthAreRefused) {
  LidarModel model = PandarXt32();
  model.firing_delay.pop_back();
  EXPECT_THROW(LidarSimulator(Room(), model, {}, 1), InputError);
}

class Walker : public testing::Test {
 protected:
  Walker() { room_.people = {{{{2.0, -2.0, 0.0}, {2.0, 2.0, 0.0}}, 1.0, 0.0}}; }

  /// Centre of the points that are inside the room, away from its surfaces.
  Vector3d SeenAt(double time, bool people) const {
    LidarOptions options = Exact();
    options.people = people;
    const LidarSimulator lidar(room_, PandarXt32(), options, 1);
    Vector3d sum = Vector3d::Zero();
    int count = 0;
    for (const Point& point : lidar.Sweep(time, StillPose).points) {
      const Vector3d at = StillPose(0.0) * Position(point);
      if (lidar.DistanceToSurface(at, 0.2) < 0.02) continue;
      sum += at;
      ++count;
    }
    return count == 0 ? Vector3d::Zero() : Vector3d(sum / count);
  }

  World room_ = Room();
};

TEST_F(Walker, IsSeenWhereItWalks) {
  EXPECT_NEAR(SeenAt(1.0, true).y(), -1.0, 0.15);
  EXPECT_NEAR(SeenAt(3.0, true).y(), 1.0, 0.15);
  EXPECT_NEAR(SeenAt(1.0, true).x(), 2.0, 0.25);
  EXPECT_NEAR(SeenAt(7.0, true).y(), -1.0, 0.15);  // on the way back
  EXPECT_TRUE(SeenAt(1.0, false).isZero());
}

TEST_F(Walker, FeetFollowTheClosedPath) {
  const PersonPath& path = room_.people[0];
  EXPECT_TRUE(FeetAt(path, 0.0).isApprox(Vector3d(2.0, -2.0, 0.0)));
  EXPECT_TRUE(FeetAt(path, 5.0).isApprox(Vector3d(2.0, 1.0, 0.0)));
  EXPECT_TRUE(FeetAt(path, 8.0).isApprox(Vector3d(2.0, -2.0, 0.0)));
}

TEST(Pedestrian, CapsuleIsHitOnItsSkin) {
  const PersonPath path{{{10.0, 0.0, 0.0}, {11.0, 0.0, 0.0}}, 0.0, 0.0};
  const Pedestrian person = PedestrianAt(path, 0.0);
  Hit hit;
  Intersect(person, {Eigen::Vector3f(0.0F, 0.0F, 1.2F), Eigen::Vector3f::UnitX()}, hit);
  EXPECT_NEAR(hit.range, 10.0F - person.parts[0].radius, 1e-4F);
  EXPECT_NEAR(hit.cosine, 1.0F, 1e-3F);
  Hit nearer{3.0F, 1.0F, 0.5F};
  Intersect(person, {Eigen::Vector3f(0.0F, 0.0F, 1.2F), Eigen::Vector3f::UnitX()}, nearer);
  EXPECT_EQ(nearer.range, 3.0F);
  Hit away;
  Intersect(person, {Eigen::Vector3f(0.0F, 0.0F, 1.2F), -Eigen::Vector3f::UnitX()}, away);
  EXPECT_FALSE(std::isfinite(away.range));
}

}  // namespace
}  // namespace hv::sim
