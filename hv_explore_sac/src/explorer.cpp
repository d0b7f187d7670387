#include "hv_explore_sac/explorer.h"

#include <algorithm>
#include <utility>

#include "progress_watch.h"

namespace hv::explore {
namespace {

constexpr double kNever_s = -1e9;
constexpr int kMostPeriods = 5;  ///< of decisions that are waited for after a failure

ExplorationEnd EndOf(Outlook outlook) {
  switch (outlook) {
    case Outlook::kNothing:
      return ExplorationEnd::kExplored;
    case Outlook::kNoFreePlace:
      return ExplorationEnd::kNoFreePlace;
    default:
      return ExplorationEnd::kUnreachable;
  }
}

/// In one line; empty when nothing is missing.
std::string MissingInput(const ExplorerInput& input) {
  if (!input.map) return "there is no map yet";
  if (!input.T_map_base) return "the place in the map is not known";
  return input.navigation_ready ? "" : "nobody takes goals to drive to";
}

/// Lasts for a while from when it is first told.
class Spell {
 public:
  double LengthAt(double now_s) {
    if (!since_s_) since_s_ = now_s;
    return now_s - *since_s_;
  }
  void Break() { since_s_.reset(); }

 private:
  std::optional<double> since_s_;
};

}  // namespace

const char* ToString(ExplorerState state) {
  switch (state) {
    case ExplorerState::kIdle:
      return "idle";
    case ExplorerState::kWaiting:
      return "waiting";
    case ExplorerState::kExploring:
      return "exploring";
    case ExplorerState::kReturning:
      return "returning";
    case ExplorerState::kPaused:
      return "paused";
  }
  return "";
}

/// A task under way. Times are those of ExplorationProgress::elapsed_s.
struct Explorer::Run {
  Run(ExplorationTask exploration, double step_m) : task(std::move(exploration)), watch(step_m) {}

  ExplorationTask task;
  ProgressWatch watch;
  std::optional<navigation::PlanarPose> home;
  std::optional<Eigen::Vector2d> noted;  ///< where it last stood, for the choice of goals
  std::optional<GoalOutcome> outcome;    ///< that has not been judged yet
  bool driving = false;                  ///< navigation has a goal
  bool arrived = false;                  ///< since the last decision
  double decided_s = kNever_s;
  int others = 0;  ///< decisions in a row for other goals than that under way
  int failures = 0;
  std::string failure;
  bool second_chance = true;  ///< for goals that were refused, once nothing else is left
  Spell nothing_left;
  Spell without_inputs;
  std::optional<ExplorationEnd> end;  ///< known, while the robot returns
  std::string end_reason;
  int home_tries = 0;
};

Explorer::Explorer(const ExplorerConfig& config, const RobotSize& size,
                   GoalChooser::PlannerMaker make_planner)
    : config_(config), size_(size), make_planner_(std::move(make_planner)) {
  if (make_planner_) return;
  make_planner_ = [name = config.choice.planner](const PlannerInputs& inputs) {
    return MakePlanner(name, inputs);
  };
}

Explorer::~Explorer() = default;

void Explorer::Start(const ExplorationTask& task) {
  const bool driving = run_ && run_->driving;
  run_ = std::make_unique<Run>(task, config_.goals.stuck_m);
  run_->driving = driving;
  chooser_ = std::make_unique<GoalChooser>(config_, size_, task.bounds, make_planner_);
  progress_ = ExplorationProgress();
  goal_.reset();
  cancel_ = paused_ = false;
}

ExplorerOutput Explorer::Update(const ExplorerInput& input) {
  ExplorerOutput output;
  Advance(input);
  if (!run_) return output;
  const double budget_s = run_->task.time_budget_s;
  if (cancel_) {
    Finish(ExplorationEnd::kCancelled, "", output);
  } else if (paused_) {
    Pause(output);
  } else if (!HasInputs(input, output)) {
    return output;
  } else if (run_->end) {
    ReturnHome(output);
  } else if (budget_s > 0.0 && progress_.elapsed_s >= budget_s) {
    Conclude(ExplorationEnd::kOutOfTime, "", output);
  } else {
    Explore(input, output);
  }
  return output;
}

/// What is broken off is begun anew afterwards.
void Explorer::Pause(ExplorerOutput& output) {
  if (run_->end && run_->driving) --run_->home_tries;
  StopDriving(output);
  run_->decided_s = kNever_s;
  output.state = ExplorerState::kPaused;
}

/// Time and place. Jumps of the clock count nothing.
void Explorer::Advance(const ExplorerInput& input) {
  constexpr double kJump_s = 10.0;
  const double step_s = last_ ? input.now - *last_ : 0.0;
  last_ = input.now;
  if (!run_) return;
  if (!paused_ && step_s > 0.0 && step_s < kJump_s) progress_.elapsed_s += step_s;
  if (input.outcome) run_->outcome = input.outcome;
  if (!input.T_map_base) return;
  const Eigen::Vector2d& position = input.T_map_base->position;
  if (!run_->home) run_->home = input.T_map_base;
  run_->watch.Add(position, progress_.elapsed_s);
  progress_.travelled_m = run_->watch.driven_m();
  if (run_->noted && (*run_->noted - position).norm() < config_.places.spacing_m) return;
  run_->noted = position;
  chooser_->NoteStood(position);
}

bool Explorer::HasInputs(const ExplorerInput& input, ExplorerOutput& output) {
  output.reason = MissingInput(input);
  if (output.reason.empty()) {
    run_->without_inputs.Break();
    return true;
  }
  output.state = ExplorerState::kWaiting;
  const double silent_s = run_->without_inputs.LengthAt(progress_.elapsed_s);
  if (silent_s > config_.goals.inputs_lost_s) {
    Finish(ExplorationEnd::kInputsLost, output.reason, output);
  }
  return false;
}

void Explorer::Explore(const ExplorerInput& input, ExplorerOutput& output) {
  output.state = ExplorerState::kExploring;
  const bool judged = JudgeGoal(input.T_map_base->position, output);
  if (!run_ || run_->end) return;
  const bool due = progress_.elapsed_s >= run_->decided_s + config_.choice.period_s;
  // Another plan may begin with a turn, for which there must be room.
  const bool on_the_way = goal_ && !chooser_->CanTurnAt(input.T_map_base->position);
  if (judged || (due && !on_the_way)) Decide(input, output);
}

/// Whether the robot has arrived, so that another goal is to be chosen at once.
bool Explorer::JudgeGoal(const Eigen::Vector2d& robot, ExplorerOutput& output) {
  const std::optional<GoalOutcome> outcome = std::exchange(run_->outcome, std::nullopt);
  if (outcome) run_->driving = false;
  if (!goal_) return false;
  const double distance_m = (goal_->pose.position - robot).norm();
  const bool near = distance_m <= config_.goals.reached_m && chooser_->CanTurnAt(robot);
  if (near || (outcome && outcome->reached)) {
    Arrive();
    return true;
  }
  if (outcome) {
    Fail(outcome->reason, output);
  } else if (run_->watch.StandsFor(progress_.elapsed_s) > config_.goals.stuck_s) {
    Fail("the robot does not get on", output);
  }
  return false;
}

void Explorer::Arrive() {
  run_->noted = goal_->pose.position;
  chooser_->NoteStood(goal_->pose.position);
  run_->arrived = true;
  run_->failures = 0;
  run_->second_chance = true;
  goal_.reset();
}

void Explorer::Fail(const std::string& reason, ExplorerOutput& output) {
  ++progress_.failed_goals;
  ++run_->failures;
  run_->failure = reason;
  chooser_->Refuse(*goal_);
  // What is in the way of all goals may go by itself.
  const double patience_s = config_.choice.period_s * std::min(run_->failures, kMostPeriods);
  run_->decided_s = progress_.elapsed_s + patience_s - config_.choice.period_s;
  StopDriving(output);
  if (run_->failures < config_.goals.failures) return;
  Conclude(ExplorationEnd::kNavigationFails, reason, output);
}

void Explorer::Decide(const ExplorerInput& input, ExplorerOutput& output) {
  run_->decided_s = progress_.elapsed_s;
  ++progress_.decisions;
  const Outlook outlook = chooser_->Look(*input.map, input.T_map_base->position);
  progress_.explored_m2 = chooser_->free_m2();
  progress_.frontiers = static_cast<int>(chooser_->model()->frontiers().points().size());
  if (outlook != Outlook::kGoals) {
    NothingLeft(outlook, output);
    return;
  }
  run_->nothing_left.Break();
  ChooseGoal(output);
}

void Explorer::ChooseGoal(ExplorerOutput& output) {
  const bool arrived = std::exchange(run_->arrived, false);
  const ViewpointGoal next = chooser_->Choose(arrived);
  if (arrived && chooser_->in_loop()) ++progress_.loops;
  if (!KeepsGoal(next)) {
    goal_ = next;
    run_->others = 0;
    ++progress_.goals;
    Drive(next.pose, output);
  }
  output.reason =
      "drives to a viewpoint that observes " + std::to_string(goal_->utility) + " frontier points";
}

/// A goal on the way stays until it is worth nothing, or others have been chosen several times.
bool Explorer::KeepsGoal(const ViewpointGoal& other) {
  if (!goal_ || !chooser_->IsWorth(*goal_)) return false;
  run_->others = other.cell == goal_->cell ? 0 : run_->others + 1;
  return chooser_->in_loop() || run_->others < config_.choice.insist;
}

/// The map may lag behind, so that this must last before it counts.
void Explorer::NothingLeft(Outlook outlook, ExplorerOutput& output) {
  output.reason = ToString(EndOf(outlook));
  const bool stands_wrong = outlook == Outlook::kNoFreePlace;
  if (stands_wrong && goal_) return;
  StopDriving(output);
  const double patience_s = stands_wrong ? config_.goals.inputs_lost_s : config_.goals.settle_s;
  if (run_->nothing_left.LengthAt(progress_.elapsed_s) < patience_s) return;
  if (outlook == Outlook::kRefused && std::exchange(run_->second_chance, false)) {
    chooser_->ForgetRefusals();
    run_->nothing_left.Break();
    return;
  }
  const bool refused = outlook == Outlook::kRefused;
  Conclude(EndOf(outlook), refused ? run_->failure : "", output);
}

void Explorer::Conclude(ExplorationEnd end, const std::string& reason, ExplorerOutput& output) {
  StopDriving(output);
  if (end == ExplorationEnd::kExplored) chooser_->End();
  if (!run_->task.return_home || !AllowsReturn(end)) {
    Finish(end, reason, output);
    return;
  }
  run_->end = end;
  run_->end_reason = reason;
}

void Explorer::ReturnHome(ExplorerOutput& output) {
  output.state = ExplorerState::kReturning;
  output.reason = ToString(*run_->end);
  std::optional<GoalOutcome> outcome = std::exchange(run_->outcome, std::nullopt);
  if (run_->driving && run_->watch.StandsFor(progress_.elapsed_s) > config_.goals.stuck_s) {
    outcome = GoalOutcome{false, "the robot does not get on"};
  }
  if (run_->driving && !outcome) return;
  if (run_->home_tries > 0 && outcome && outcome->reached) {
    Finish(*run_->end, run_->end_reason, output);
  } else if (run_->home_tries >= config_.goals.home_tries) {
    const std::string failure = outcome ? outcome->reason : "";
    Finish(*run_->end, "the way home failed: " + failure, output);
    output.result->success = false;
  } else {
    ++run_->home_tries;
    Drive(*run_->home, output);
  }
}

void Explorer::Drive(const navigation::PlanarPose& goal, ExplorerOutput& output) {
  output.goal = goal;
  output.stop = false;
  run_->driving = true;
  run_->outcome.reset();
  run_->watch.Restart(progress_.elapsed_s);
}

void Explorer::StopDriving(ExplorerOutput& output) {
  output.stop = output.stop || run_->driving;
  run_->driving = false;
  goal_.reset();
}

void Explorer::Finish(ExplorationEnd end, const std::string& reason, ExplorerOutput& output) {
  StopDriving(output);
  ExplorationResult result;
  result.end = end;
  result.reason = ToString(end);
  if (!reason.empty()) result.reason += "; " + reason;
  result.success = Completes(end);
  result.progress = progress_;
  output.result = result;
  output.state = ExplorerState::kIdle;
  output.reason = result.reason;
  run_.reset();
  cancel_ = paused_ = false;
}

}  // namespace hv::explore
