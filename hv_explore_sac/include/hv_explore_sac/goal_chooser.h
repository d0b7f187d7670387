#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "hv_core/occupancy_grid.h"
#include "hv_explore_sac/explorer_config.h"
#include "hv_explore_sac/known_place.h"
#include "hv_explore_sac/loop_guard.h"
#include "hv_explore_sac/planner.h"
#include "hv_navigation/planar.h"

namespace hv::explore {

/// A viewpoint to drive to.
struct ViewpointGoal {
  Eigen::Vector2i cell = Eigen::Vector2i::Zero();
  navigation::PlanarPose pose;  ///< in the map, looking the way the robot comes
  int utility = 0;              ///< frontier points it observes; 0: a step on the way
};

/// What a map offers to explore.
enum class Outlook {
  kGoals,       ///< there are goals
  kRefused,     ///< but for those that were refused
  kUnreached,   ///< frontiers are left, which no way leads to
  kNothing,     ///< no viewpoint observes frontiers
  kNoFreePlace  ///< the robot does not stand near free ground
};

/// Chooses viewpoints where the robot can turn, if there are any, in a map that may grow and shift
/// between the calls: the model is made anew from each map, and where the robot has stood, what was
/// refused and what the planner remembers stay. The same calls give the same choices. Not
/// thread-safe.
class GoalChooser {
 public:
  using PlannerMaker = std::function<std::unique_ptr<Planner>(const PlannerInputs&)>;

  GoalChooser(const ExplorerConfig& config, const RobotSize& size, Bounds bounds,
              PlannerMaker make_planner);

  /// The robot stood at a place [m], from where it has seen what there is.
  void NoteStood(const Eigen::Vector2d& position);

  /// A goal could not be reached: it and what is near are left alone for a while.
  void Refuse(const ViewpointGoal& goal) { refused_.Refuse(goal.cell); }
  void ForgetRefusals();

  /// Takes a map and where the robot is in it; what follows is about that.
  Outlook Look(const OccupancyGrid& map, const Eigen::Vector2d& robot);

  /// Whether the robot can turn at a place, as far as the last map tells.
  bool CanTurnAt(const Eigen::Vector2d& position) const;

  /// Whether a goal can be reached and still observes what it was chosen for.
  bool IsWorth(const ViewpointGoal& goal) const;

  /// The next goal, after Look() has told that there are some. `arrived`: the robot stands where a
  /// choice has led it, so that loops would show; `in_loop()` tells whether they do.
  ViewpointGoal Choose(bool arrived);
  bool in_loop() const { return in_loop_; }
  /// Nothing is left to explore, as far as the map of the last Look() tells.
  void End();

  /// Where the way to a goal turns, from the robot on [m]; empty when there is none.
  std::vector<Eigen::Vector2d> WayTo(const ViewpointGoal& goal) const;

  /// Null before the first map.
  const ExplorationModel* model() const { return model_.get(); }
  const CellFrame& frame() const { return frame_; }
  const Observation& observation() const { return observation_; }
  double free_m2() const { return free_m2_; }  ///< known, inside of the bounds

 private:
  void FollowMap(const OccupancyGrid& map);
  void KeepGates(const Eigen::Vector2i& robot);
  void AvoidNarrowPlaces();
  std::optional<Eigen::Vector2i> CellOfRobot(const Eigen::Vector2d& robot) const;
  std::vector<Eigen::Vector2i> StoodCells() const;
  int NodeOf(const ViewpointGoal& goal) const;
  bool AnyUnreachedUtility() const;
  ViewpointGoal GoalAt(int node) const;

  ExplorerConfig config_;
  RobotSize size_;
  PlaceRules rules_;
  PlannerMaker make_planner_;
  CellFrame frame_;
  std::unique_ptr<Planner> planner_;
  LoopGuard guard_;
  RefusedGoals refused_;
  std::vector<Eigen::Vector2d> stood_;  ///< oldest first [m]
  std::optional<navigation::ClearanceGrid> clearance_;
  std::unique_ptr<ExplorationModel> model_;
  Observation observation_;
  double free_m2_ = 0.0;
  double most_free_m2_ = 0.0;
  bool in_loop_ = false;
};

}  // namespace hv::explore
