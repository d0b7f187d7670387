#include "hv_replay/robot_locator.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "box_room.h"
#include "pose_history.h"
#include "simulated_robot.h"

namespace hv::replay {
namespace {

BaseMotion At(double seconds, double x) {
  return {Time::FromSeconds(100.0 + seconds),
          MakePose(Eigen::Matrix3d(Eigen::Matrix3d::Identity()), {x, 0.0, 0.0}),
          {x, 0.0}};
}

TEST(PoseHistoryTest, InterpolatesWithinWhatItKeeps) {
  PoseHistory history;
  EXPECT_FALSE(history.At(Time::FromSeconds(100.0)));
  for (int k = 0; k <= 30; ++k) history.Add(At(0.1 * k, k));
  EXPECT_FALSE(history.At(Time::FromSeconds(101.5)));
  EXPECT_NEAR(history.At(Time::FromSeconds(102.25))->T_odom_base.translation().x(), 22.5, 1e-6);
  EXPECT_EQ(history.At(Time::FromSeconds(103.04))->T_odom_base.translation().x(), 30.0);
  EXPECT_FALSE(history.At(Time::FromSeconds(103.1)));
}

TEST(PoseHistoryTest, ALaterWordAboutATimeCounts) {
  PoseHistory history;
  history.Add(At(0.0, 0.0));
  history.Add(At(0.2, 5.0));
  history.Add(At(0.1, 1.0));
  EXPECT_NEAR(history.At(Time::FromSeconds(100.05))->T_odom_base.translation().x(), 0.5, 1e-6);
}

/// A robot that drives a circle in a hall.
class Circling {
 public:
  Circling() {
    config_.start = {0.0, 0.0, 0.0, 0.0};
    config_.point_share = 0.1;
    config_.truth_rate_hz = 200.0;
    config_.robot.drive.command_timeout_s = 1e3;
  }

  /// Calls `look` with each scan located, and where the base truly was at its end.
  template <typename Look>
  void Run(RobotLocator& locator, double still_s, double seconds, const Look& look) {
    sim::LiveSimulation simulation(sim::BoxRoom(12.0F, 9.0F), config_);
    while (simulation.time_s() < still_s + seconds) {
      if (simulation.time_s() > still_s) simulation.Command({0.6, 0.8});
      simulation.Step([&](sim::LiveMessage message) {
        if (auto* sample = std::get_if<ImuSample>(&message)) locator.AddImu(*sample);
        if (auto* state = std::get_if<sim::TrueState>(&message)) locator.AddTruth(*state);
        if (auto* scan = std::get_if<Scan>(&message)) locator.AddScan(std::move(*scan));
      });
      while (const auto scan = locator.NextScan()) look(*scan, simulation);
    }
  }

  sim::SensorRig rig() const { return sim::MakeRig(config_.suite); }

 private:
  sim::LiveConfig config_;
};

TEST(RobotLocatorTest, ByTheTruthScansLieOnTheWalls) {
  Circling robot;
  const auto locator = LocateByTruth(Pose::Identity(), robot.rig());
  const sim::RayCaster hall(sim::BoxRoom(12.0F, 9.0F).mesh);
  double worst_m = 0.0;
  int points = 0;
  robot.Run(*locator, 0.1, 2.0, [&](const LocatedScan& scan, const sim::LiveSimulation&) {
    for (std::size_t i = 0; i < scan.points.size(); i += 13) {
      const Point& point = scan.points[i];
      const Eigen::Vector3d at = scan.T_odom_base * robot.rig().T_base_lidar *
                                 Eigen::Vector3f(point.x, point.y, point.z).cast<double>();
      worst_m = std::max(worst_m, hall.Distance(at, 1.0));
      ++points;
    }
  });
  EXPECT_GT(points, 3000);
  EXPECT_LT(worst_m, 0.08);  // noise of the range, 1 cm, in the far tail
}

TEST(RobotLocatorTest, BySensorsTheBaseIsWhereOdometrySays) {
  Circling robot;
  const auto locator = LocateBySensors(SimulatedRobot(), "", robot.rig());
  std::optional<Pose> T_world_odom;
  double worst_m = 0.0;
  double worst_mps = 0.0;
  int places = 0;
  robot.Run(*locator, 2.0, 4.0, [&](const LocatedScan&, const sim::LiveSimulation& simulation) {
    const auto place = locator->At(simulation.now());
    if (!place) return;
    const sim::MotionState truth = simulation.State();
    if (!T_world_odom) T_world_odom = truth.T_world_body * place->T_odom_base.inverse();
    const Pose T_world_base = *T_world_odom * place->T_odom_base;
    worst_m =
        std::max(worst_m, (T_world_base.translation() - truth.T_world_body.translation()).norm());
    const double speed_mps = (truth.T_world_body.linear().transpose() * truth.velocity).x();
    worst_mps = std::max(worst_mps, std::abs(place->velocity.linear_mps - speed_mps));
    EXPECT_TRUE(place->localized);
    ++places;
  });
  EXPECT_GT(places, 30);
  EXPECT_LT(worst_m, 0.06);
  EXPECT_LT(worst_mps, 0.1);
}

}  // namespace
}  // namespace hv::replay
