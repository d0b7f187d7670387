#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hv_core/occupancy_grid.h"
#include "hv_core/time.h"
#include "hv_explore_sac/exploration_task.h"
#include "hv_explore_sac/goal_chooser.h"

namespace hv::explore {

enum class ExplorerState { kIdle, kWaiting, kExploring, kReturning, kPaused };

const char* ToString(ExplorerState state);

/// How a goal given to the navigation has ended.
struct GoalOutcome {
  bool reached = false;
  std::string reason;  ///< why not, one line
};

/// What is known when an Explorer is asked.
struct ExplorerInput {
  Time now;
  std::shared_ptr<const OccupancyGrid> map;          ///< null while there is none
  std::optional<navigation::PlanarPose> T_map_base;  ///< nullopt while that is not known
  std::optional<GoalOutcome> outcome;                ///< of the newest goal, once
  bool navigation_ready = true;                      ///< whether goals can be given
};

struct ExplorerOutput {
  ExplorerState state = ExplorerState::kIdle;
  std::string reason;                          ///< what it does or waits for, one line
  std::optional<navigation::PlanarPose> goal;  ///< to be driven to from now on, in the map
  bool stop = false;                           ///< the goal under way is to be given up
  std::optional<ExplorationResult> result;     ///< when the exploration ends
};

/// From a task to its result: chooses viewpoints, decides anew on the way (rolling replanning),
/// leaves alone what navigation cannot reach, ends with a reason, and returns home. Knows no clock
/// and no navigation: time and outcomes are inputs, so that the same inputs give the same outputs.
/// Not thread-safe.
class Explorer {
 public:
  /// `make_planner`: instead of the planner that the configuration names; a must for one that is
  /// learned, whose weights this library cannot read.
  Explorer(const ExplorerConfig& config, const RobotSize& size,
           GoalChooser::PlannerMaker make_planner = nullptr);
  ~Explorer();

  /// Takes the place of a task under way. The task must have no problem.
  void Start(const ExplorationTask& task);
  /// The next update ends the task, if there is one.
  void Cancel() { cancel_ = true; }
  /// The robot stands until it is told to go on.
  void SetPaused(bool paused) { paused_ = paused; }
  bool paused() const { return paused_; }
  bool Active() const { return run_ != nullptr; }

  /// To be called a few times a second.
  ExplorerOutput Update(const ExplorerInput& input);

  /// Of the task under way, or the last one.
  const ExplorationProgress& progress() const { return progress_; }
  /// What was last looked at; null before the first map of a task.
  const GoalChooser* chooser() const { return chooser_.get(); }
  /// The viewpoint under way.
  const std::optional<ViewpointGoal>& goal() const { return goal_; }

 private:
  struct Run;

  void Advance(const ExplorerInput& input);
  void Pause(ExplorerOutput& output);
  bool HasInputs(const ExplorerInput& input, ExplorerOutput& output);
  void Explore(const ExplorerInput& input, ExplorerOutput& output);
  bool JudgeGoal(const Eigen::Vector2d& robot, ExplorerOutput& output);
  void Arrive();
  void Fail(const std::string& reason, ExplorerOutput& output);
  void Decide(const ExplorerInput& input, ExplorerOutput& output);
  void ChooseGoal(ExplorerOutput& output);
  bool KeepsGoal(const ViewpointGoal& other);
  void NothingLeft(Outlook outlook, ExplorerOutput& output);
  void Conclude(ExplorationEnd end, const std::string& reason, ExplorerOutput& output);
  void ReturnHome(ExplorerOutput& output);
  void Drive(const navigation::PlanarPose& goal, ExplorerOutput& output);
  void StopDriving(ExplorerOutput& output);
  void Finish(ExplorationEnd end, const std::string& reason, ExplorerOutput& output);

  ExplorerConfig config_;
  RobotSize size_;
  GoalChooser::PlannerMaker make_planner_;
  std::unique_ptr<GoalChooser> chooser_;
  std::unique_ptr<Run> run_;
  std::optional<ViewpointGoal> goal_;
  ExplorationProgress progress_;
  std::optional<Time> last_;
  bool cancel_ = false;
  bool paused_ = false;
};

}  // namespace hv::explore
