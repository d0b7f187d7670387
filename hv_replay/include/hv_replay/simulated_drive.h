#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hv_core/occupancy_grid.h"
#include "hv_navigation/navigator.h"
#include "hv_navigation/surroundings.h"
#include "hv_replay/robot_locator.h"
#include "hv_replay/slam_config.h"
#include "hv_sim/live_simulation.h"

namespace hv::replay {

/// What happened in one control cycle, and what it cost.
struct DriveCycle {
  Time stamp;
  navigation::NavigationOutput output;
  std::optional<RobotPlace> place;
  Pose T_world_base = Pose::Identity();  ///< the truth
  std::vector<sim::Collision> collisions;
  std::vector<double> update_ms;  ///< of the obstacle map, a value a scan
  std::vector<double> depth_ms;   ///< the same, a value a depth image
  double grids_ms = 0.0;          ///< for the 2-D grids
  double control_ms = 0.0;        ///< for the navigator without plans
  std::size_t octree_nodes = 0;
  std::size_t walkers = 0;  ///< who are noticed
  bool moved_on = true;  ///< odometry was not interrupted
};

/// A robot in a simulated world with everything that drives it, in lock-step: it waits for every
/// computation, so that the same configuration gives the same drive. Not thread-safe.
class SimulatedDrive {
 public:
  static constexpr double kPeriod_s = 0.1;  ///< of control

  /// `saved`: the grid of the prior map. Throws InputError like LiveSimulation.
  SimulatedDrive(sim::World world, const sim::LiveConfig& simulation, const SlamConfig& config,
                 std::unique_ptr<RobotLocator> locator, std::optional<OccupancyGrid> saved);

  /// In the map; takes the place of a goal under way.
  void SetGoal(const navigation::PlanarPose& goal) { navigator_.SetGoal(goal); }
  void Cancel() { navigator_.Cancel(); }

  /// Simulates a period, then one control cycle.
  DriveCycle Cycle();

  /// Another obstacle.
  void Add(const sim::TimedBox& box) { simulation_.Add(box); }
  /// Forgets what was seen of the map.
  void ForgetViews() { surroundings_.ForgetViews(); }

  const navigation::SurroundingsView& view() const { return surroundings_.view(); }
  double time_s() const { return simulation_.time_s(); }

 private:
  void Take(sim::LiveMessage message, DriveCycle& cycle);
  void TakeImage(const DepthImage& image, DriveCycle& cycle);
  void TakeScans(DriveCycle& cycle);
  void Control(DriveCycle& cycle);

  sim::LiveSimulation simulation_;
  std::unique_ptr<RobotLocator> locator_;
  navigation::Surroundings surroundings_;
  navigation::Navigator navigator_;
  Pose T_base_lidar_;
  Pose T_base_optical_;
  navigation::DepthCameraModel camera_;
  std::uint32_t segment_ = 0;
  bool scanned_ = false;  ///< since the last control cycle
};

}  // namespace hv::replay
