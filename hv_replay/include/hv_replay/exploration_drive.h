#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hv_core/trajectory.h"
#include "hv_explore_sac/explorer.h"
#include "hv_replay/collision_log.h"
#include "hv_replay/csv_log.h"
#include "hv_replay/json.h"
#include "hv_replay/reachable_ground.h"
#include "hv_replay/simulated_drive.h"
#include "hv_sim/live_config.h"

namespace hv::replay {

/// How a simulated world is explored, besides what the configuration file says.
struct ExplorationDriveOptions {
  std::string out;  ///< folder for the results
  double time_limit_s = 1800.0;
  bool return_home = false;
  bool truth_pose = false;  ///< the robot is told where it is, instead of odometry
};

/// What was known at some time.
struct CoveragePoint {
  double time_s = 0.0;
  double travelled_m = 0.0;  ///< truly
  double explored_m2 = 0.0;  ///< known to be free
  double share = 0.0;        ///< of the ground that the robot can get to, 0 to 1
};

/// How an exploration in simulation went.
struct ExplorationDriveResult {
  explore::ExplorationResult exploration;
  double reachable_m2 = 0.0;
  std::vector<CoveragePoint> coverage;  ///< a point a second, and the last
  CollisionCount collisions;
  std::vector<Eigen::Vector2d> line;  ///< driven, truly, in the map [m]
  std::vector<double> decision_ms;    ///< a value a decision

  /// The first point at which so much was known; null when it never was.
  const CoveragePoint* WhenKnown(double share) const;
};

/// Over the whole run, for summary.json and `--json`.
JsonObject SummaryJson(const ExplorationDriveResult& result);

/// Explores a simulated world with the cores that the nodes use, in lock-step, and judges by the
/// truth. The same for the same arguments, but for times that are measured.
class ExplorationDrive {
 public:
  /// Creates the folder for the results and reads the weights of a learned planner. Throws
  /// InputError.
  ExplorationDrive(const SlamConfig& config, sim::World world, const sim::LiveConfig& simulation,
                   const ExplorationDriveOptions& options);

  /// Explores to the end and writes coverage.csv, goals.csv, collisions.csv, path.tum (the true
  /// poses in the map), summary.json, config.yaml and exploration.png. Throws InputError when the
  /// robot does not find its place.
  ExplorationDriveResult Run();

 private:
  explore::ExplorerOutput Explore(ExplorationDriveResult& result);
  explore::ExplorerInput InputNow() const;
  void Note(ExplorationDriveResult& result);
  void NoteCoverage(ExplorationDriveResult& result);
  void NoteGoal(const explore::ExplorerOutput& output);
  void Write(const ExplorationDriveResult& result) const;

  SlamConfig config_;
  ExplorationDriveOptions options_;
  sim::RobotShape shape_;  ///< with what it keeps free around itself
  sim::World world_;
  std::unique_ptr<SimulatedDrive> drive_;
  explore::Explorer explorer_;
  std::unique_ptr<ReachableGround> ground_;
  Pose T_map_world_ = Pose::Identity();
  DriveCycle last_;
  double began_s_ = 0.0;
  double travelled_m_ = 0.0;
  std::vector<StampedPose> path_;
  CsvLog coverage_log_;
  CsvLog goal_log_;
  CollisionLog collision_log_;
};

}  // namespace hv::replay
