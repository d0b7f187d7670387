#include "hv_explore_sac/goal_chooser.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hv_explore_sac/gates.h"

namespace hv::explore {
namespace {

/// Farthest that the robot may be from free ground, as when it stands close to a wall [m].
constexpr double kFreeWithin_m = 1.0;
/// A map that knows less than this share of what was known has been begun anew.
constexpr double kForgottenShare = 0.7;

}  // namespace

GoalChooser::GoalChooser(const ExplorerConfig& config, const RobotSize& size, Bounds bounds,
                         PlannerMaker make_planner)
    : config_(config),
      size_(size),
      rules_{size.drive_m + config.places.margin_m, std::move(bounds)},
      make_planner_(std::move(make_planner)),
      guard_(GuardConfig()),
      refused_(GuardConfig()) {}

void GoalChooser::NoteStood(const Eigen::Vector2d& position) { stood_.push_back(position); }

void GoalChooser::ForgetRefusals() { refused_ = RefusedGoals(config_.GuardInCells(frame_.cell_m)); }

Outlook GoalChooser::Look(const OccupancyGrid& map, const Eigen::Vector2d& robot) {
  FollowMap(map);
  PlaceRules rules = rules_;
  rules.driven = StoodCells();
  rules.driven.push_back(frame_.CellOf(robot));
  model_ = std::make_unique<ExplorationModel>(
      ModelOf(*clearance_, frame_, rules, config_.InCells(frame_.cell_m)));
  observation_ = Observation();
  const std::optional<Eigen::Vector2i> cell = CellOfRobot(robot);
  if (!cell) return Outlook::kNoFreePlace;
  if (config_.places.only_gates) KeepGates(*cell);
  model_->Recall(StoodCells(), config_.goals.reached_m / frame_.cell_m);
  model_->Update(*cell);
  model_->Observe(observation_);
  const int refused = refused_.Apply(observation_, *model_);
  AvoidNarrowPlaces();
  if (observation_.AnyUtility()) return Outlook::kGoals;
  if (refused > 0) return Outlook::kRefused;
  return AnyUnreachedUtility() ? Outlook::kUnreached : Outlook::kNothing;
}

/// Cells stay named as they are; only other ones than before make all that remembers them begin
/// anew.
void GoalChooser::FollowMap(const OccupancyGrid& map) {
  const double margin_m = config_.places.margin_m + map.resolution_m;
  clearance_.emplace(map, navigation::ClearanceGrid::Unknown::kFree, size_.turn_m + margin_m);
  free_m2_ = FreeArea(map, rules_.bounds);
  if (free_m2_ < kForgottenShare * most_free_m2_) {
    stood_.clear();
    most_free_m2_ = 0.0;
  }
  most_free_m2_ = std::max(most_free_m2_, free_m2_);
  if (planner_ && map.resolution_m == frame_.cell_m) return;
  frame_ = {map.resolution_m, map.origin};
  const GuardConfig guard = config_.GuardInCells(frame_.cell_m);
  guard_ = LoopGuard(guard);
  refused_ = RefusedGoals(guard);
  planner_ = make_planner_(
      {config_.PlannerInCells(frame_.cell_m), config_.InCells(frame_.cell_m), nullptr, nullptr});
}

/// Frontier points lie beside gates no farther than the robot is wide, and blocks are whole ones.
void GoalChooser::KeepGates(const Eigen::Vector2i& robot) {
  constexpr double kAround_blocks = 2.0;
  constexpr double kBeyond_blocks = 3.0;  // a block, and one beside it over the corner
  const int block = model_->config().frontier.block;
  GateRules rules;
  rules.least_cells = config_.places.min_unseen_m2 / (frame_.cell_m * frame_.cell_m);
  rules.around = rules_.room_m / frame_.cell_m + kAround_blocks * block;
  rules.beyond = kBeyond_blocks * block;
  CloseBesideGates(model_->ground(), robot, rules, model_->belief());
}

bool GoalChooser::CanTurnAt(const Eigen::Vector2d& position) const {
  return !clearance_ || clearance_->ClearanceAt(position) >= size_.turn_m;
}

/// Where the robot cannot turn it may get stuck: such viewpoints are for when there are no others.
void GoalChooser::AvoidNarrowPlaces() {
  Observation roomy = observation_;
  for (Observation::Node& node : roomy.nodes) {
    const Eigen::Vector2d at = frame_.CenterOf(model_->graph().CellOf(node.viewpoint));
    if (clearance_->ClearanceAt(at) < size_.turn_m + config_.places.margin_m) node.utility = 0;
  }
  if (roomy.AnyUtility()) observation_ = std::move(roomy);
}

/// While the robot is near where it last stood, it stands there.
std::optional<Eigen::Vector2i> GoalChooser::CellOfRobot(const Eigen::Vector2d& robot) const {
  const Belief& belief = model_->ground();
  if (!stood_.empty() && (stood_.back() - robot).norm() <= config_.goals.reached_m) {
    const Eigen::Vector2i cell = frame_.CellOf(stood_.back());
    if (belief.Contains(cell) && belief.At(cell) == Cell::kFree) return cell;
  }
  return NearestFree(belief, frame_, robot, kFreeWithin_m);
}

std::vector<Eigen::Vector2i> GoalChooser::StoodCells() const {
  std::vector<Eigen::Vector2i> cells;
  for (const Eigen::Vector2d& position : stood_) cells.push_back(frame_.CellOf(position));
  return cells;
}

bool GoalChooser::AnyUnreachedUtility() const {
  for (int viewpoint = 0; viewpoint < model_->graph().size(); ++viewpoint) {
    if (!model_->ways().Reached(viewpoint) && model_->UtilityOf(viewpoint) > 0) return true;
  }
  return false;
}

int GoalChooser::NodeOf(const ViewpointGoal& goal) const {
  for (int i = 0; i < observation_.size(); ++i) {
    if (model_->graph().CellOf(observation_.node(i).viewpoint) == goal.cell) return i;
  }
  return -1;
}

bool GoalChooser::IsWorth(const ViewpointGoal& goal) const {
  const int node = NodeOf(goal);
  return node >= 0 && (goal.utility == 0 || observation_.node(node).utility > 0);
}

ViewpointGoal GoalChooser::Choose(bool arrived) {
  Decision decision = planner_->Choose(observation_, *model_);
  if (arrived) {
    const Decision reviewed = guard_.Review(decision, observation_, *model_);
    in_loop_ = reviewed.goal != decision.goal;
    decision = reviewed;
  }
  return GoalAt(decision.goal);
}

void GoalChooser::End() {
  if (planner_ && model_->robot() >= 0) planner_->End(*model_);
}

ViewpointGoal GoalChooser::GoalAt(int node) const {
  const Observation::Node& at = observation_.node(node);
  ViewpointGoal goal;
  goal.cell = model_->graph().CellOf(at.viewpoint);
  goal.pose.position = frame_.CenterOf(goal.cell);
  goal.utility = at.utility;
  if (at.predecessor >= 0) {
    const Eigen::Vector2f way = at.position - observation_.node(at.predecessor).position;
    goal.pose.yaw = static_cast<double>(std::atan2(way.y(), way.x()));
  }
  return goal;
}

std::vector<Eigen::Vector2d> GoalChooser::WayTo(const ViewpointGoal& goal) const {
  std::vector<Eigen::Vector2d> way;
  for (int node = NodeOf(goal); node >= 0; node = observation_.node(node).predecessor) {
    way.push_back(frame_.CenterOf(model_->graph().CellOf(observation_.node(node).viewpoint)));
  }
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace hv::explore
