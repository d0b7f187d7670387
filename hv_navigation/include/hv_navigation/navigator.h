#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hv_core/time.h"
#include "hv_navigation/global_planner.h"
#include "hv_navigation/local_planner.h"
#include "hv_navigation/obstacle_memory.h"
#include "hv_navigation/planning_config.h"
#include "hv_navigation/planning_worker.h"

namespace hv::navigation {

/// What is known at a control cycle. The local frame is that of the local grid, in which the robot
/// moves smoothly; the pose in the map may jump.
struct NavigationInput {
  Time now;
  PlanarPose T_map_base;
  PlanarPose T_local_base;
  Time pose_stamp;        ///< of the poses
  bool localized = true;  ///< whether the pose in the map can be trusted
  Velocity velocity;      ///< driven now
  std::shared_ptr<const ClearanceGrid> map;
  bool map_has_additions = false;  ///< it holds obstacles that the saved map does not
  std::shared_ptr<const ClearanceGrid> local_grid;
  /// The same without those who walk, since plans need not mind them; null where nobody is told.
  std::shared_ptr<const ClearanceGrid> standing_grid;
  std::shared_ptr<const Walkers> walkers;  ///< they, in the local frame
  Time obstacles_stamp;  ///< of the oldest among the newest data of the obstacle sensors
};

/// What the next seconds are driven through; refers to the input.
inline ObstaclesAhead AheadOf(const NavigationInput& input) {
  return {*input.local_grid, input.walkers.get(), input.now};
}

enum class NavigationState {
  kIdle,
  kPlanning,  ///< stands and waits for the first plan
  kDriving,
  kWaiting,  ///< for something to get out of the way
  kTurning,  ///< to look around
  kBackingOff,
  kPaused,  ///< without sensors or place
};

enum class NavigationResult { kReached, kNoPath, kBlocked, kCancelled, kInputsLost };

struct NavigationOutput {
  Velocity velocity;
  NavigationState state = NavigationState::kIdle;
  std::string reason;                 ///< why it is in this state, or has ended so; one line
  std::shared_ptr<const Path> plan;   ///< in the map; null without one
  Path trajectory;                    ///< of the next seconds, in the local frame
  double remaining_m = 0.0;           ///< of the plan
  int recoveries = 0;                 ///< tried since it last got on
  std::optional<double> planning_ms;  ///< of a plan that came in this cycle, found or not
  bool look_again = false;            ///< asks for obstacles that can be seen again to be forgotten
  bool forget_additions = false;      ///< the same for what the saved map does not hold
  std::optional<NavigationResult> result;  ///< in the cycle in which a goal ends
};

const char* ToString(NavigationState state);
const char* ToString(NavigationResult result);

/// The first of the inputs that are missing or too old to drive with, in one line; empty when all
/// are there.
std::string MissingInput(const NavigationInput& input, const NavigatorConfig& config);

class Recovery;

/// From goal to result: plans, follows, minds what appears, recovers, and gives up with a reason.
/// Knows no clock: time is an input, so that with PlanningWorker::Mode::kAtOnce the same inputs
/// give the same outputs. Not thread-safe.
class Navigator {
 public:
  Navigator(const PlanningConfig& config, PlanningWorker::Mode mode);
  ~Navigator();

  /// Takes the place of a goal under way: the robot goes on along the old plan until the new one is
  /// there. `goal` is in the map.
  void SetGoal(const PlanarPose& goal);
  /// The next cycle ends the goal, if there is one, and brakes.
  void Cancel();
  bool HasGoal() const { return pursuit_.has_value(); }

  /// One control cycle.
  NavigationOutput Update(const NavigationInput& input);

 private:
  void Pursue(const NavigationInput& input, NavigationOutput& output);
  bool CheckInputs(const NavigationInput& input, NavigationOutput& output);
  void FollowFrame(const NavigationInput& input);
  void CheckPath(const NavigationInput& input);
  void ConsiderPlanning(const NavigationInput& input);
  PlanningJob JobNow(const NavigationInput& input) const;
  void TakePlan(const NavigationInput& input, NavigationOutput& output);
  void JudgeProblem(const NavigationInput& input, const FinishedPlan& finished,
                    NavigationOutput& output);
  bool IsWorthTaking(const GlobalPlan& plan) const;
  double LeastRemaining(const GlobalPlan& plan) const;
  void Drive(const NavigationInput& input, NavigationOutput& output);
  void ArriveAtEnd(const NavigationInput& input, NavigationOutput& output);
  void NoteProgress(const NavigationInput& input, const LocalPlan& local);
  void Stuck(const NavigationInput& input, const std::string& reason, NavigationOutput& output);
  void Finish(NavigationResult result, const std::string& reason, NavigationOutput& output);

  /// Of the goal under way.
  struct Pursuit {
    PlanarPose goal;
    std::optional<Time> requested;  ///< the last plan
    std::string problem;            ///< of that plan; empty when found
    bool problem_certain = false;   ///< the map alone shows it
    bool cornered = false;          ///< it is that the robot cannot turn where it stands
    std::optional<Time> doubted;    ///< when additions to the map were to be forgotten
    std::optional<Time> progress;   ///< when it last got on
    std::optional<Time> stuck_since;
  };
  /// The plan being followed, which may lead to the goal before.
  struct Course {
    int goal_id = 0;
    std::shared_ptr<const Path> path;  ///< in the map
    PlanarPose T_local_map;            ///< with which the local planner has it
    double cost_per_m = 1.0;
    double remaining_m = 0.0;
    double least_remaining_m = 0.0;
    std::shared_ptr<const ClearanceGrid> map;  ///< in which it was found free
    bool falls_short = false;                  ///< of the goal, which is not free
    bool blocked = false;
    bool strayed = false;
  };

  PlanningConfig config_;
  LocalPlanner local_;
  std::unique_ptr<Recovery> recovery_;
  int goal_id_ = 0;
  std::optional<Pursuit> pursuit_;
  std::optional<Course> course_;
  std::optional<Velocity> asked_;  ///< in the cycle before
  ObstacleMemory memory_;          ///< of what blocked paths
  std::optional<Time> inputs_lost_since_;
  bool cancel_ = false;
  PlanningWorker worker_;
};

}  // namespace hv::navigation
