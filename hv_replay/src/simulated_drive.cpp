#include "hv_replay/simulated_drive.h"

#include <chrono>
#include <cmath>
#include <utility>

#include "hv_core/elapsed.h"

namespace hv::replay {
namespace {

using Clock = std::chrono::steady_clock;

navigation::DepthCameraModel ModelOf(const sim::DepthCameraConfig& camera) {
  return {camera.fx(), camera.fy(), camera.cx(), camera.cy()};
}

/// True states at each sample of the IMU.
sim::LiveConfig WithTruth(sim::LiveConfig config) {
  config.truth_rate_hz = config.suite.imu.rate_hz;
  return config;
}

}  // namespace

SimulatedDrive::SimulatedDrive(sim::World world, const sim::LiveConfig& simulation,
                               const SlamConfig& config, std::unique_ptr<RobotLocator> locator,
                               std::optional<OccupancyGrid> saved)
    : simulation_(std::move(world), WithTruth(simulation)),
      locator_(std::move(locator)),
      surroundings_(config.navigation.mapping, config.navigation.planning.NeededClearance(),
                    std::move(saved)),
      navigator_(config.navigation.planning, navigation::PlanningWorker::Mode::kAtOnce),
      T_base_lidar_(sim::MakeRig(simulation.suite).T_base_lidar),
      T_base_optical_(simulation.camera.mounting() * sim::OpticalInCamera()),
      camera_(ModelOf(simulation.camera)) {}

DriveCycle SimulatedDrive::Cycle() {
  DriveCycle cycle;
  const auto steps = std::lround(kPeriod_s / simulation_.step_s());
  for (long k = 0; k < steps; ++k) {
    simulation_.Step([&](sim::LiveMessage message) { Take(std::move(message), cycle); });
    TakeScans(cycle);
  }
  Control(cycle);
  return cycle;
}

void SimulatedDrive::Take(sim::LiveMessage message, DriveCycle& cycle) {
  if (const auto* sample = std::get_if<ImuSample>(&message)) {
    locator_->AddImu(*sample);
  } else if (const auto* state = std::get_if<sim::TrueState>(&message)) {
    locator_->AddTruth(*state);
  } else if (auto* scan = std::get_if<Scan>(&message)) {
    locator_->AddScan(std::move(*scan));
  } else if (const auto* image = std::get_if<DepthImage>(&message)) {
    TakeImage(*image, cycle);
  } else if (const auto* collision = std::get_if<sim::Collision>(&message)) {
    cycle.collisions.push_back(*collision);
  }
}

void SimulatedDrive::TakeImage(const DepthImage& image, DriveCycle& cycle) {
  const std::optional<RobotPlace> place = locator_->At(image.stamp);
  if (!place) return;
  const Clock::time_point begin = Clock::now();
  surroundings_.AddDepth(image, camera_, place->T_odom_base * T_base_optical_, place->T_odom_base);
  cycle.depth_ms.push_back(MillisecondsSince(begin));
}

void SimulatedDrive::TakeScans(DriveCycle& cycle) {
  while (const std::optional<LocatedScan> scan = locator_->NextScan()) {
    if (scan->segment != segment_) {
      surroundings_.ForgetObstacles();
      cycle.moved_on = false;
      segment_ = scan->segment;
    }
    const Clock::time_point begin = Clock::now();
    surroundings_.AddScan(scan->stamp, scan->points, scan->T_odom_base * T_base_lidar_,
                          scan->T_odom_base);
    cycle.update_ms.push_back(MillisecondsSince(begin));
    scanned_ = true;
  }
}

void SimulatedDrive::Control(DriveCycle& cycle) {
  cycle.stamp = simulation_.now();
  cycle.place = locator_->At(cycle.stamp);
  navigation::NavigationInput input;
  input.now = cycle.stamp;
  if (cycle.place) {
    const RobotPlace& place = *cycle.place;
    std::optional<Pose> T_map_odom;
    if (place.localized) T_map_odom = place.T_map_odom;
    const Clock::time_point begin = Clock::now();
    if (scanned_) surroundings_.Update(place.T_odom_base, T_map_odom);
    scanned_ = false;
    cycle.grids_ms = MillisecondsSince(begin);
    input.T_map_base = navigation::Planar(place.T_map_odom * place.T_odom_base);
    input.T_local_base = navigation::Planar(place.T_odom_base);
    input.pose_stamp = place.stamp;
    input.velocity = place.velocity;
  }
  input.localized = cycle.place && cycle.place->localized;
  input.map = view().map;
  input.map_has_additions = view().map_has_additions;
  input.local_grid = view().local;
  input.standing_grid = view().standing;
  input.walkers = view().walkers;
  input.obstacles_stamp = view().obstacles_stamp;
  const Clock::time_point begin = Clock::now();
  cycle.output = navigator_.Update(input);
  cycle.control_ms = MillisecondsSince(begin) - cycle.output.planning_ms.value_or(0.0);
  if (cycle.output.look_again) surroundings_.LookAgain();
  if (cycle.output.forget_additions) surroundings_.ForgetAdditions();
  simulation_.Command({cycle.output.velocity.linear_mps, cycle.output.velocity.angular_rps});
  cycle.T_world_base = simulation_.State().T_world_body;
  cycle.walkers = view().walkers ? view().walkers->all().size() : 0;
  cycle.octree_nodes = surroundings_.obstacle_map().node_count();
}

}  // namespace hv::replay
