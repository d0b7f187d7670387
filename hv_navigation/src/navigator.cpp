#include "hv_navigation/navigator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "recovery.h"

namespace hv::navigation {
namespace {

constexpr int kLooksAtGoal = 3;  // before one that is not free is given up
constexpr char kGoalNotFree[] = "the goal is in or too near to an obstacle";

PlanarPose LocalFromMap(const NavigationInput& input) {
  return input.T_local_base * input.T_map_base.Inverse();
}

/// What plans have to lead around.
SeenObstacles Standing(const NavigationInput& input) {
  return {input.standing_grid ? input.standing_grid : input.local_grid,
          LocalFromMap(input).Inverse()};
}

bool Within(const std::optional<Time>& since, Time now, double duration_s) {
  return since && now - *since < duration_s;
}

}  // namespace

std::string MissingInput(const NavigationInput& input, const NavigatorConfig& config) {
  if (!input.map) return "no map yet";
  if (!input.local_grid) return "no obstacle grid yet";
  if (!input.localized) return "the place in the map is lost";
  if (input.now - input.pose_stamp > config.pose_timeout_s) return "the pose is too old";
  if (input.now - input.obstacles_stamp > config.obstacles_timeout_s) {
    return "the obstacle sensors are silent";
  }
  return "";
}

const char* ToString(NavigationState state) {
  switch (state) {
    case NavigationState::kIdle:
      return "idle";
    case NavigationState::kPlanning:
      return "planning";
    case NavigationState::kDriving:
      return "driving";
    case NavigationState::kWaiting:
      return "waiting";
    case NavigationState::kTurning:
      return "turning";
    case NavigationState::kBackingOff:
      return "backing off";
    case NavigationState::kPaused:
      return "paused";
  }
  return "";
}

const char* ToString(NavigationResult result) {
  switch (result) {
    case NavigationResult::kReached:
      return "reached";
    case NavigationResult::kNoPath:
      return "no path";
    case NavigationResult::kBlocked:
      return "blocked";
    case NavigationResult::kCancelled:
      return "cancelled";
    case NavigationResult::kInputsLost:
      return "inputs lost";
  }
  return "";
}

Navigator::Navigator(const PlanningConfig& config, PlanningWorker::Mode mode)
    : config_(config),
      local_(config.local, config.limits, config.footprint),
      recovery_(std::make_unique<Recovery>(config.navigator, local_)),
      memory_(config.navigator.remember_s),
      worker_(GlobalPlanner(config.global, config.footprint), mode) {}

Navigator::~Navigator() = default;

void Navigator::SetGoal(const PlanarPose& goal) {
  ++goal_id_;
  if (!pursuit_) asked_.reset();  // others may have driven it since
  pursuit_ = Pursuit();
  pursuit_->goal = goal;
  cancel_ = false;
  recovery_->Reset();
}

void Navigator::Cancel() { cancel_ = pursuit_.has_value(); }

void Navigator::Finish(NavigationResult result, const std::string& reason,
                       NavigationOutput& output) {
  output.velocity = result == NavigationResult::kReached ? Velocity() : output.velocity;
  output.trajectory.clear();
  output.result = result;
  output.reason = reason;
  output.state = NavigationState::kIdle;
  pursuit_.reset();
  course_.reset();
  local_.SetPath({});
  recovery_->Reset();
  inputs_lost_since_.reset();
  cancel_ = false;
}

NavigationOutput Navigator::Update(const NavigationInput& input) {
  NavigationOutput output;
  output.velocity = local_.Brake(input.velocity, asked_.value_or(input.velocity));
  if (pursuit_) Pursue(input, output);
  asked_ = output.velocity;
  return output;
}

void Navigator::Pursue(const NavigationInput& input, NavigationOutput& output) {
  if (cancel_) return Finish(NavigationResult::kCancelled, "cancelled", output);
  if (course_) output.plan = course_->path;
  if (!CheckInputs(input, output)) return;
  if (!pursuit_->progress) pursuit_->progress = input.now;
  FollowFrame(input);
  CheckPath(input);
  ConsiderPlanning(input);
  TakePlan(input, output);
  if (course_) output.plan = course_->path;
  output.recoveries = recovery_->tried();
  Drive(input, output);
}

/// Without inputs it stands, and goes on when they are back.
bool Navigator::CheckInputs(const NavigationInput& input, NavigationOutput& output) {
  const std::string missing = MissingInput(input, config_.navigator);
  if (missing.empty()) {
    // The time spent waiting is no fault of the way.
    if (inputs_lost_since_) pursuit_->progress = input.now;
    inputs_lost_since_.reset();
    return true;
  }
  if (!inputs_lost_since_) inputs_lost_since_ = input.now;
  output.state = NavigationState::kPaused;
  output.reason = missing;
  if (!Within(inputs_lost_since_, input.now, config_.navigator.inputs_lost_s)) {
    Finish(NavigationResult::kInputsLost, missing, output);
  }
  return false;
}

/// The map moves in the local frame whenever localisation corrects odometry.
void Navigator::FollowFrame(const NavigationInput& input) {
  if (!course_) return;
  const PlanarPose T_local_map = LocalFromMap(input);
  local_.MovePath(T_local_map * course_->T_local_map.Inverse());
  course_->T_local_map = T_local_map;
}

void Navigator::CheckPath(const NavigationInput& input) {
  if (!course_) return;
  constexpr double kWholePath_m = 1e6;
  const bool seen_free =
      local_.PathIsFree(*Standing(input).grid, PlanarPose(), config_.navigator.check_ahead_m);
  const bool known_free =
      input.map == course_->map ||
      local_.PathIsFree(*input.map, course_->T_local_map.Inverse(), kWholePath_m);
  if (known_free) course_->map = input.map;
  const bool blocked = !seen_free || !known_free;
  if (blocked && !course_->blocked) pursuit_->requested.reset();
  if (!seen_free && !course_->blocked) {
    memory_.Add(input.now, Standing(input).MissingIn(*input.map));
  }
  course_->blocked = blocked;
}

PlanningJob Navigator::JobNow(const NavigationInput& input) const {
  PlanningJob job;
  job.goal_id = goal_id_;
  job.request.start = input.T_map_base;
  job.request.goal = pursuit_->goal;
  job.request.goal_tolerance_m = config_.navigator.goal_slack_m;
  job.request.yaw_tolerance = config_.navigator.goal_yaw_slack;
  job.request.approach_m = config_.navigator.approach_m;
  job.map = input.map;
  job.seen = Standing(input);
  job.remembered = memory_.Places();
  return job;
}

void Navigator::ConsiderPlanning(const NavigationInput& input) {
  const bool on_course = course_ && course_->goal_id == goal_id_;
  const bool urgent =
      !on_course || course_->blocked || course_->strayed || pursuit_->stuck_since.has_value();
  const double period_s = urgent ? config_.navigator.retry_s : config_.navigator.replan_s;
  const bool first = !pursuit_->requested.has_value();
  if (!first && (Within(pursuit_->requested, input.now, period_s) || worker_.Busy())) return;
  memory_.Review(input.now, Standing(input));
  worker_.Request(JobNow(input));
  pursuit_->requested = input.now;
}

/// Changing the plan costs smoothness: where all is well it must be worth it.
bool Navigator::IsWorthTaking(const GlobalPlan& plan) const {
  if (!course_ || course_->goal_id != goal_id_) return true;
  if (course_->blocked || course_->strayed || pursuit_->stuck_since) return true;
  if (course_->falls_short && !plan.falls_short) return true;
  const double present = course_->cost_per_m * course_->remaining_m;
  return plan.cost < config_.navigator.better_plan * present;
}

/// A new plan is no progress, nor does one as long as the old one undo any.
double Navigator::LeastRemaining(const GlobalPlan& plan) const {
  constexpr double kDetour_m = 1.0;
  if (!course_ || course_->goal_id != goal_id_) return plan.length_m;
  const double detour_m = plan.length_m - course_->remaining_m;
  return course_->least_remaining_m + (detour_m > kDetour_m ? detour_m : 0.0);
}

/// Certain is what the map alone shows, but for what was seen there since it was saved: who stood
/// in a door may have gone. That is forgotten once a goal, and has some time to be seen again.
void Navigator::JudgeProblem(const NavigationInput& input, const FinishedPlan& finished,
                             NavigationOutput& output) {
  constexpr double kSeeAgain_s = 2.5;
  const PlanOutcome outcome = finished.plan.outcome;
  pursuit_->problem = finished.plan.reason;
  pursuit_->cornered = outcome == PlanOutcome::kCornered;
  pursuit_->problem_certain =
      !finished.with_obstacles && !pursuit_->cornered && outcome != PlanOutcome::kStartBlocked;
  if (finished.plan.Found() || !pursuit_->problem_certain) return;
  if (input.map_has_additions && !pursuit_->doubted) {
    pursuit_->doubted = input.now;
    output.forget_additions = true;
  }
  pursuit_->problem_certain = !Within(pursuit_->doubted, input.now, kSeeAgain_s);
}

void Navigator::TakePlan(const NavigationInput& input, NavigationOutput& output) {
  const std::optional<FinishedPlan> finished = worker_.Take();
  if (!finished || finished->goal_id != goal_id_) return;
  output.planning_ms = finished->planning_ms;
  const GlobalPlan& plan = finished->plan;
  JudgeProblem(input, *finished, output);
  if (!plan.Found()) {
    const bool leads_elsewhere = course_ && course_->goal_id != goal_id_;
    if (leads_elsewhere) course_.reset();
    return;
  }
  if (!IsWorthTaking(plan)) return;
  const double least_m = LeastRemaining(plan);
  course_ = Course();
  course_->goal_id = goal_id_;
  course_->path = std::make_shared<const Path>(plan.path);
  course_->T_local_map = LocalFromMap(input);
  course_->cost_per_m = plan.length_m > 0.0 ? plan.cost / plan.length_m : 1.0;
  course_->remaining_m = plan.length_m;
  course_->least_remaining_m = least_m;
  course_->falls_short = plan.falls_short;
  course_->map = input.map;
  local_.SetPath(*course_->path);
  local_.MovePath(course_->T_local_map);
}

void Navigator::Drive(const NavigationInput& input, NavigationOutput& output) {
  if (recovery_->Active()) {
    if (recovery_->Run(input, output)) return;
    pursuit_->requested.reset();
    pursuit_->stuck_since.reset();
  }
  if (!course_) {
    output.state = NavigationState::kPlanning;
    if (!pursuit_->problem.empty()) Stuck(input, pursuit_->problem, output);
    return;
  }
  const LocalPlan local = local_.Plan(AheadOf(input), input.T_local_base, input.velocity);
  if (local.velocity) output.velocity = *local.velocity;
  output.trajectory = local.trajectory;
  output.remaining_m = course_->remaining_m = local.remaining_m;
  course_->strayed = local.off_path_m > config_.navigator.stray_m;
  if (local.state == LocalState::kReached) return ArriveAtEnd(input, output);
  NoteProgress(input, local);
  const bool idles = !Within(pursuit_->progress, input.now, config_.navigator.stuck_s);
  if (local.state != LocalState::kDriving || idles) {
    const bool blocked = local.state != LocalState::kDriving;
    Stuck(input, blocked ? local.reason : "the robot does not get on", output);
    return;
  }
  output.state = NavigationState::kDriving;
  if (course_->blocked) output.reason = "the path is blocked ahead; " + pursuit_->problem;
}

/// Of the path, which may belong to the goal before, or end before a goal that is not free.
void Navigator::ArriveAtEnd(const NavigationInput& input, NavigationOutput& output) {
  output.state = NavigationState::kPlanning;
  if (course_->goal_id != goal_id_) return;
  if (!course_->falls_short) return Finish(NavigationResult::kReached, "", output);
  if (recovery_->tried() < kLooksAtGoal) return Stuck(input, kGoalNotFree, output);
  Finish(NavigationResult::kNoPath, kGoalNotFree, output);
}

void Navigator::NoteProgress(const NavigationInput& input, const LocalPlan& local) {
  constexpr double kMoving_mps = 0.05;
  const bool moves = std::abs(input.velocity.linear_mps) > kMoving_mps;
  if (local.state == LocalState::kDriving && moves) pursuit_->stuck_since.reset();
  if (local.remaining_m > course_->least_remaining_m - config_.navigator.progress_m) return;
  course_->least_remaining_m = local.remaining_m;
  pursuit_->progress = input.now;
  recovery_->Reset();
}

/// Waits, recovers, and at last gives up.
void Navigator::Stuck(const NavigationInput& input, const std::string& reason,
                      NavigationOutput& output) {
  output.state = NavigationState::kWaiting;
  output.reason = reason;
  const bool no_other_way = !pursuit_->problem.empty() && pursuit_->problem != reason;
  if (no_other_way) output.reason += "; " + pursuit_->problem;
  if (!pursuit_->stuck_since) pursuit_->stuck_since = input.now;
  if (!course_ && pursuit_->problem_certain) {
    return Finish(NavigationResult::kNoPath, output.reason, output);
  }
  // Only who is cornered gains nothing by waiting, unless trying to get out has not helped.
  const bool may_pass = course_ || !pursuit_->cornered || recovery_->tried() > 0;
  if (may_pass && Within(pursuit_->stuck_since, input.now, config_.navigator.wait_s)) return;
  const bool enough = recovery_->tried() >= config_.navigator.recoveries ||
                      !Within(pursuit_->progress, input.now, config_.navigator.give_up_s);
  if (enough) {
    const bool no_path = pursuit_->problem_certain && !pursuit_->problem.empty();
    return Finish(no_path ? NavigationResult::kNoPath : NavigationResult::kBlocked, output.reason,
                  output);
  }
  recovery_->Begin(input, pursuit_->cornered, output);
}

}  // namespace hv::navigation
