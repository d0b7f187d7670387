#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hv_core/occupancy_grid.h"
#include "hv_replay/csv_log.h"
#include "hv_replay/drive_journal.h"
#include "hv_replay/goal_sampler.h"
#include "hv_replay/navigation_scenario.h"
#include "hv_replay/navigation_trial.h"
#include "hv_replay/simulated_drive.h"
#include "hv_replay/slam_config.h"
#include "hv_sim/live_config.h"

namespace hv::replay {

/// What is driven, besides what the simulation and the configuration file say.
struct NavigationRunOptions {
  std::string map;        ///< map folder with a grid; empty: odometry alone, the map is its frame
  std::string map_truth;  ///< TUM file with the true poses of the run that made the map
  std::string out;        ///< folder for the results
  int goals = 10;
  double least_m = 5.0;     ///< from a goal to the next
  bool truth_pose = false;  ///< the robot is told where it is
  NavigationScenario scenario = NavigationScenario::kRandom;
};

/// Drives from one random goal to the next in a simulated world, with the cores that the nodes use,
/// and judges each drive by the truth. The same for the same arguments, but for times that are
/// measured.
class NavigationRun {
 public:
  /// Creates the folder for the results and reads the map. Throws InputError.
  NavigationRun(const SlamConfig& config, sim::World world, const sim::LiveConfig& simulation,
                const NavigationRunOptions& options);

  /// Drives to all goals, as far as there are any, and writes trials.csv, collisions.csv,
  /// cycles.csv (a row a control cycle), summary.json, config.yaml and drives.png. With a scenario,
  /// goals count to which there was a place for a box, and at most thrice as many are tried. Throws
  /// InputError when the robot does not find its place.
  std::vector<NavigationTrial> Run();

 private:
  void FindPlace();
  std::optional<GoalSampler::Goal> NextGoal();
  NavigationTrial Drive(const GoalSampler::Goal& goal, int number);
  void PutBox(const DriveCycle& cycle, NavigationTrial& trial);
  void NoteResponse(const DriveCycle& cycle, NavigationTrial& trial);
  void WaitForBoxToGo();
  void Draw(const std::vector<NavigationTrial>& trials) const;
  DriveSituation SituationAt(const DriveCycle& cycle) const;
  navigation::PlanarPose InMap(const Pose& T_world_base) const;

  SlamConfig config_;
  NavigationRunOptions options_;
  std::string title_;
  Pose T_map_world_ = Pose::Identity();
  std::optional<OccupancyGrid> saved_;
  double floor_radius_m_;  ///< of the largest circle in the footprint, without margin
  std::uint32_t seed_;
  std::unique_ptr<SimulatedDrive> drive_;
  std::optional<GoalSampler> goals_;
  std::optional<sim::TimedBox> box_;  ///< of the drive under way
  DriveCycle last_;
  std::unique_ptr<CsvLog> trial_log_;
  std::unique_ptr<DriveJournal> journal_;
};

}  // namespace hv::replay
