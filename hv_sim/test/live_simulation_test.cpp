#include "hv_sim/live_simulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <yaml-cpp/yaml.h>

#include "box_room.h"
#include "hv_core/error.h"
#include "hv_core/so3.h"
#include "hv_sim/mesh_builder.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

constexpr double kEpoch_s = 1700000000.0;

/// Standing in the middle of a hall, looking along x.
LiveConfig Small() {
  LiveConfig config;
  config.start = {0.0, 0.0, 0.0, 0.0};
  config.point_share = 0.05;
  config.robot.drive.command_timeout_s = 1e3;
  return config;
}

World EmptyHall() { return BoxRoom(12.0F, 9.0F); }

/// Everything that a simulation has said, by kind.
struct Log {
  void Run(LiveSimulation& simulation, double seconds) {
    const auto steps = std::lround(seconds / simulation.step_s());
    for (long k = 0; k < steps; ++k) {
      simulation.Step(
          [this](LiveMessage message) { std::visit([this](auto& data) { Keep(data); }, message); });
    }
  }
  void Keep(ImuSample& sample) { imu.push_back(sample); }
  void Keep(Scan& scan) { scans.push_back(std::move(scan)); }
  void Keep(DepthImage& image) { images.push_back(std::move(image)); }
  void Keep(TrueState& state) { truth.push_back(state); }
  void Keep(Collision& collision) { collisions.push_back(collision); }

  std::vector<ImuSample> imu;
  std::vector<Scan> scans;
  std::vector<DepthImage> images;
  std::vector<TrueState> truth;
  std::vector<Collision> collisions;
};

double SecondsOf(Time stamp) { return stamp - Time::FromSeconds(kEpoch_s); }

TEST(LiveSimulationTest, MessagesComeAtTheirRatesWithTheirStamps) {
  LiveSimulation simulation(EmptyHall(), Small());
  Log log;
  log.Run(simulation, 2.0);
  ASSERT_EQ(log.imu.size(), 400U);
  for (std::size_t k = 0; k < log.imu.size(); ++k) {
    EXPECT_NEAR(SecondsOf(log.imu[k].stamp), 0.005 * static_cast<double>(k + 1), 1e-9);
  }
  ASSERT_EQ(log.scans.size(), 19U);
  for (std::size_t k = 0; k < log.scans.size(); ++k) {
    EXPECT_NEAR(SecondsOf(log.scans[k].stamp), 0.02 + 0.1 * static_cast<double>(k), 1e-9);
    EXPECT_NEAR(log.scans[k].duration, 0.1, 0.002);
  }
  ASSERT_EQ(log.images.size(), 31U);
  for (std::size_t k = 0; k < log.images.size(); ++k) {
    EXPECT_NEAR(SecondsOf(log.images[k].stamp), static_cast<double>(k) / 15.0, 1e-9);
  }
  EXPECT_EQ(log.truth.size(), 101U);
  EXPECT_EQ(simulation.now() - log.imu.back().stamp, 0.0);
}

TEST(LiveSimulationTest, EachStepEndsWithWhatIsCompleteByThen) {
  LiveSimulation simulation(EmptyHall(), Small());
  for (int k = 0; k < 200; ++k) {
    bool imu_seen = false;
    simulation.Step([&](const LiveMessage& message) {
      if (std::holds_alternative<ImuSample>(message)) imu_seen = true;
      if (const Scan* scan = std::get_if<Scan>(&message)) {
        EXPECT_TRUE(imu_seen);
        EXPECT_LE(scan->end(), simulation.now());
        EXPECT_GT(scan->end(), simulation.now() - 0.006);
      }
    });
    EXPECT_TRUE(imu_seen);
  }
}

TEST(LiveSimulationTest, AtRestTheImuFeelsGravityOnly) {
  LiveConfig config = Small();
  config.suite.imu.noise = false;
  LiveSimulation simulation(EmptyHall(), config);
  Log log;
  log.Run(simulation, 0.5);
  for (const ImuSample& sample : log.imu) {
    EXPECT_LT((sample.acceleration - Vector3d(0.0, 0.0, kGravity)).norm(), 1e-6);
    EXPECT_LT(sample.angular_velocity.norm(), 1e-9);
  }
}

/// The true pose at a time, between states that are 5 ms apart.
Pose PoseAt(const std::vector<TrueState>& truth, Time stamp) {
  const auto after = std::find_if(truth.begin() + 1, truth.end(),
                                  [&](const TrueState& state) { return state.stamp >= stamp; });
  const Pose& a = std::prev(after)->base.T_world_body;
  const Pose& b = after->base.T_world_body;
  const double share = (stamp - std::prev(after)->stamp) / (after->stamp - std::prev(after)->stamp);
  const Eigen::Matrix3d rotation =
      a.linear() * so3::Exp(share * so3::Log(a.linear().transpose() * b.linear()));
  return MakePose(rotation, a.translation() + share * (b.translation() - a.translation()));
}

TEST(LiveSimulationTest, UndistortedScansLieOnTheWalls) {
  LiveConfig config = Small();
  config.lidar_noise = false;
  config.truth_rate_hz = 200.0;
  LiveSimulation simulation(EmptyHall(), config);
  const Pose T_base_lidar = MakeRig(config.suite).T_base_lidar;
  const RayCaster hall(EmptyHall().mesh);
  Log log;
  simulation.Command({0.8, 1.0});
  log.Run(simulation, 2.5);
  ASSERT_GT(log.truth.back().base.angular_velocity.z(), 0.9);
  double worst = 0.0;
  int points = 0;
  for (const Scan& scan : log.scans) {
    for (std::size_t i = 0; i < scan.points.size(); i += 7) {
      const Point& point = scan.points[i];
      const Pose T_world_base = PoseAt(log.truth, scan.stamp + static_cast<double>(point.time));
      const Vector3d at =
          T_world_base * T_base_lidar * Eigen::Vector3f(point.x, point.y, point.z).cast<double>();
      worst = std::max(worst, hall.Distance(at, 1.0));
      ++points;
    }
  }
  EXPECT_GT(points, 5000);
  EXPECT_LT(worst, 5e-4);
}

TEST(LiveSimulationTest, DepthIsThatOfTheWallAhead) {
  LiveConfig config = Small();
  config.camera.noise = false;
  LiveSimulation simulation(EmptyHall(), config);
  Log log;
  log.Run(simulation, 0.1);
  // The view is pitched down by 17.5 degrees; the upper rows see the wall at x = 6 m.
  const DepthCameraConfig& camera = config.camera;
  const double below = std::atan((20.0 - camera.cy()) / camera.fy()) + 17.5 * M_PI / 180.0;
  const double depth = (6.0 - 0.25) / std::cos(below) * std::cos(below - 17.5 * M_PI / 180.0);
  EXPECT_NEAR(1e-3 * log.images[0].depth_mm[20 * 212 + 106], depth, 0.02);
}

/// Everything that differs when runs differ, as numbers.
std::vector<double> Digest(const LiveConfig& config, std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  LiveSimulation simulation(EmptyHall(), config);
  Log log;
  simulation.Command({0.7, 0.4});
  log.Run(simulation, 0.6);
  std::vector<double> digest;
  for (const ImuSample& sample : log.imu) digest.push_back(sample.acceleration.x());
  for (const Scan& scan : log.scans) {
    for (const Point& point : scan.points) digest.push_back(static_cast<double>(point.x));
  }
  for (const DepthImage& image : log.images) {
    digest.insert(digest.end(), image.depth_mm.begin(), image.depth_mm.end());
  }
  return digest;
}

TEST(LiveSimulationTest, TheSeedDecidesWhateverTheNumberOfThreads) {
  LiveConfig config = Small();
  const std::vector<double> digest = Digest(config, 1);
  EXPECT_EQ(digest, Digest(config, 4));
  config.seed = 2;
  EXPECT_NE(digest, Digest(config, 1));
}

TEST(LiveSimulationTest, ARandomStartFollowsTheSeed) {
  LiveConfig config = Small();
  config.start.clear();
  const auto start = [&](int seed) {
    config.seed = seed;
    return LiveSimulation(EmptyHall(), config).State().T_world_body.matrix();
  };
  EXPECT_EQ(start(1), start(1));
  EXPECT_NE(start(1), start(2));
}

/// Points of a scan that lie in a region of the base frame; the robot stands at the origin.
int PointsWithin(const Scan& scan, const LiveConfig& config, const Vector3d& low,
                 const Vector3d& high) {
  const Pose T_base_lidar = MakeRig(config.suite).T_base_lidar;
  int count = 0;
  for (const Point& point : scan.points) {
    const Vector3d at = T_base_lidar * Eigen::Vector3f(point.x, point.y, point.z).cast<double>();
    if ((at.array() >= low.array()).all() && (at.array() <= high.array()).all()) ++count;
  }
  return count;
}

int NearPixels(const DepthImage& image, int limit_mm) {
  return static_cast<int>(std::count_if(image.depth_mm.begin(), image.depth_mm.end(),
                                        [&](int mm) { return mm > 0 && mm < limit_mm; }));
}

TEST(LiveSimulationTest, ABoxIsThereInItsTimeForEverySensor) {
  LiveConfig config = Small();
  config.boxes = {3.0, 0.0, 0.75, 0.5, 1.0, 1.5, 1.0, 2.0};
  LiveSimulation simulation(EmptyHall(), config);
  Log log;
  log.Run(simulation, 3.0);
  const Vector3d low(2.65, -0.6, 0.1);
  const Vector3d high(3.3, 0.6, 1.6);
  for (const Scan& scan : log.scans) {
    const double end_s = SecondsOf(scan.stamp) + 0.1;
    const bool there = end_s >= 1.0 && end_s < 2.0;
    EXPECT_EQ(PointsWithin(scan, config, low, high) > 20, there) << end_s;
  }
  for (const DepthImage& image : log.images) {
    const double time_s = SecondsOf(image.stamp);
    const auto at = static_cast<std::size_t>(40 * image.width + 106);
    const bool seen = image.depth_mm[at] > 0 && image.depth_mm[at] < 3000;
    EXPECT_EQ(seen, time_s >= 1.0 && time_s < 2.0) << time_s;
  }
}

TEST(LiveSimulationTest, ABoxAddedOnTheWayStopsTheRobot) {
  LiveConfig config = Small();
  config.robot.drive.slip = 0.0;  // straight on
  LiveSimulation simulation(EmptyHall(), config);
  Log log;
  simulation.Command({0.5, 0.0});
  log.Run(simulation, 1.0);
  simulation.Add({{2.0, 0.0, 0.075}, {0.2, 1.0, 0.15}, 2.0});
  log.Run(simulation, 6.0);
  ASSERT_EQ(log.collisions.size(), 1U);
  EXPECT_EQ(log.collisions[0].count, 1);
  EXPECT_EQ(simulation.collisions(), 1);
  EXPECT_EQ(log.collisions[0].contact.kind, ContactKind::kObstacle);
  EXPECT_NEAR(log.collisions[0].contact.T_world_base.translation().x(), 1.6, 0.01);
  EXPECT_NEAR(simulation.State().T_world_body.translation().x(), 1.6, 0.01);
  EXPECT_LT(simulation.State().velocity.norm(), 0.01);
}

TEST(LiveSimulationTest, LowThingsNearTheRobotAreSeenByTheCameraOnly) {
  LiveConfig config = Small();
  config.point_share = 0.3;
  config.boxes = {1.1, 0.0, 0.075, 0.2, 0.4, 0.15, 1.0, 100.0};
  LiveSimulation simulation(EmptyHall(), config);
  Log log;
  log.Run(simulation, 2.0);
  const Vector3d low(0.9, -0.3, 0.02);
  const Vector3d high(1.3, 0.3, 0.3);
  for (const Scan& scan : log.scans) EXPECT_EQ(PointsWithin(scan, config, low, high), 0);
  // 1 m along a view that looks down.
  EXPECT_GT(NearPixels(log.images.back(), 900), NearPixels(log.images.front(), 900) + 100);
}

TEST(LiveSimulationTest, ResetGoesBackToTheStartWhileTimeGoesOn) {
  LiveSimulation simulation(EmptyHall(), Small());
  Log log;
  simulation.Command({0.9, 0.3});
  log.Run(simulation, 2.0);
  EXPECT_GT(simulation.State().T_world_body.translation().norm(), 0.5);
  simulation.Reset();
  EXPECT_LT(simulation.State().T_world_body.translation().norm(), 1e-6);
  log.Run(simulation, 1.0);
  EXPECT_LT(simulation.State().T_world_body.translation().norm(), 1e-6);
  EXPECT_NEAR(simulation.time_s(), 3.0, 1e-9);
  EXPECT_EQ(log.imu.size(), 600U);
}

TEST(LiveSimulationTest, CommandsThatAreNotFiniteAreIgnored) {
  LiveSimulation simulation(EmptyHall(), Small());
  EXPECT_TRUE(simulation.Command({0.5, 0.0}));
  EXPECT_FALSE(simulation.Command({std::numeric_limits<double>::quiet_NaN(), 0.0}));
  Log log;
  log.Run(simulation, 1.5);
  EXPECT_NEAR(simulation.State().velocity.x(), 0.5, 0.06);
}

TEST(LiveSimulationTest, WithoutPeopleNobodyIsMet) {
  World world = EmptyHall();
  world.people = {{{{-5.0, 0.0, 0.0}, {5.0, 0.0, 0.0}}, 1.0, 2.0}};
  LiveConfig config = Small();
  Log with;
  LiveSimulation crowded(world, config);
  with.Run(crowded, 6.0);
  EXPECT_GE(with.collisions.size(), 1U);
  EXPECT_EQ(with.collisions[0].contact.kind, ContactKind::kPerson);
  config.people = false;
  Log without;
  LiveSimulation empty(world, config);
  without.Run(empty, 6.0);
  EXPECT_TRUE(without.collisions.empty());
}

TEST(LiveSimulationTest, ConfigurationIsChecked) {
  LiveConfig config = Small();
  config.start = {1.0};
  config.boxes = {1.0, 2.0};
  config.point_share = 0.0;
  config.robot.shape.front_m = -1.0;
  ConfigProblems problems;
  config.Validate(problems);
  EXPECT_EQ(problems.lines().size(), 4U);
  EXPECT_THROW(LiveSimulation(EmptyHall(), config), InputError);
  config = Small();
  config.start = {50.0, 0.0, 0.0, 0.0};
  EXPECT_THROW(LiveSimulation(EmptyHall(), config), InputError);
}

TEST(LiveSimulationTest, ConfigurationSurvivesYaml) {
  LiveConfig config = Small();
  config.boxes = {1.0, 2.0, 0.1, 0.2, 0.2, 0.2, 3.0, 4.0};
  config.robot.drive.max_linear_mps = 0.7;
  LiveConfig read;
  ReadConfig(ParseYaml(ToYaml(config), "text"), "text", read);
  EXPECT_EQ(ToYaml(read), ToYaml(config));
  ASSERT_EQ(read.timed_boxes().size(), 1U);
  EXPECT_EQ(read.timed_boxes()[0].size, Vector3d(0.2, 0.2, 0.2));
  EXPECT_EQ(read.timed_boxes()[0].until_s, 4.0);
}

}  // namespace
}  // namespace hv::sim
