#include "control_loop.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <ros/console.h>
#include <ros/init.h>

#include "frames.h"
#include "hv_ros/conversions.h"

namespace hv::navigation {
namespace {

constexpr double kFreshVelocity_s = 0.3;

std::unique_ptr<Navigator> MakeNavigator(const PlanningConfig& config) {
  return std::make_unique<Navigator>(config, PlanningWorker::Mode::kInBackground);
}

}  // namespace

ControlLoop::ControlLoop(ros::NodeHandle nh, const NavigationConfig& config,
                         const tf2_ros::Buffer& transforms, const OdometryBuffer& odometry,
                         MappingWorker& mapping)
    : config_(config),
      transforms_(transforms),
      odometry_(odometry),
      mapping_(mapping),
      goals_(nh, config.node.map_frame, transforms),
      publisher_(nh, config.node.map_frame, config.planning.footprint),
      navigator_(MakeNavigator(config.planning)),
      thread_([this] { Run(); }) {}

ControlLoop::~ControlLoop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  ended_.notify_all();
  if (thread_.joinable()) thread_.join();
}

ControlState ControlLoop::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_;
}

RecentDurations ControlLoop::latencies() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return latencies_;
}

/// On simulated time as well, in which only looking again tells that it has come.
bool ControlLoop::WaitUntil(ros::Time due) {
  constexpr double kLeast_s = 0.001;
  const double most_s = ros::Time::isSimTime() ? 0.002 : 0.05;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ending_) {
    const double left_s = (due - ros::Time::now()).toSec();
    if (left_s <= 0.0 || left_s > 10.0 * config_.planning.local.period_s) return true;
    ended_.wait_for(lock, std::chrono::duration<double>(std::clamp(left_s, kLeast_s, most_s)));
  }
  return false;
}

void ControlLoop::Run() {
  const ros::Duration period(config_.planning.local.period_s);
  ros::Time due = ros::Time::now();
  while (WaitUntil(due)) {
    const ros::Time now = ros::Time::now();
    const auto start = std::chrono::steady_clock::now();
    Cycle(now);
    const double elapsed_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const double late = (now - due).toSec() / period.toSec();
    const bool in_step = late >= 0.0 && late < 1.0;
    due = in_step ? due + period : now + period;
    const std::lock_guard<std::mutex> lock(mutex_);
    // The first cycle, and one after a jump of the clock, could not be in time.
    const bool counts = state_.cycles > 0 && late >= 1.0 && late < 100.0;
    if (counts) state_.missed += static_cast<std::size_t>(late);
    ++state_.cycles;
    state_.cycle_ms = elapsed_ms;
    state_.longest_cycle_ms = std::max(state_.longest_cycle_ms, elapsed_ms);
  }
  if (gate_.Next(false, Velocity())) publisher_.PublishVelocity(Velocity());
}

void ControlLoop::Cycle(ros::Time now) {
  const NavigationInput input = ReadInputs(now);
  FollowClock(input.now);
  TakeGoals();
  const bool pursuing = navigator_->HasGoal();
  const NavigationOutput output = navigator_->Update(input);
  if (const auto velocity = gate_.Next(pursuing && !output.result, output.velocity)) {
    publisher_.PublishVelocity(*velocity);
    NoteLatency(input);
  }
  Act(input, output);
  Note(input, output);
}

/// A goal does not survive a clock that jumps back: its times lie in the future then.
void ControlLoop::FollowClock(Time now) {
  constexpr double kJump_s = 0.5;
  if (last_ && now < *last_ - kJump_s) {
    ROS_WARN("the clock jumped back: a goal under way is given up");
    goals_.Abort("the clock jumped back");
    navigator_ = MakeNavigator(config_.planning);
  }
  last_ = now;
}

void ControlLoop::TakeGoals() {
  if (const auto goal = goals_.TakeGoal()) {
    navigator_->SetGoal(*goal);
    ROS_INFO_STREAM("goal: x " << goal->position.x() << " m, y " << goal->position.y()
                               << " m, heading " << goal->yaw * 180.0 / M_PI << " deg");
    const std::lock_guard<std::mutex> lock(mutex_);
    ++state_.goals;
  }
  if (navigator_->HasGoal() && (!goals_.Active() || goals_.CancelRequested())) navigator_->Cancel();
}

NavigationInput ControlLoop::ReadInputs(ros::Time now) {
  const SurroundingsView view = mapping_.view();
  NavigationInput input;
  input.now = odometry_.SensorTime(FromRos(now));
  other_clock_ = input.now != FromRos(now);
  input.map = view.map;
  input.map_has_additions = view.map_has_additions;
  input.local_grid = view.local;
  input.standing_grid = view.standing;
  input.walkers = view.walkers;
  input.velocity = gate_.last();
  input.localized = false;
  const std::optional<OdometryState> odometry = odometry_.Newest();
  if (!odometry) return input;
  const auto T_map_odom = PlaceOfOdometry(transforms_, config_.node.map_frame, odometry->odom_frame,
                                          odometry->stamp, config_.node.place_timeout_s);
  input.localized = T_map_odom.has_value();
  if (T_map_odom) T_map_odom_ = *T_map_odom;
  // Stamps in the future must not hide that nothing comes any more.
  const double ahead_s = odometry->stamp - odometry_.SensorTime(odometry->arrival);
  input.pose_stamp = odometry->stamp - std::max(0.0, ahead_s);
  input.obstacles_stamp = view.obstacles_stamp - std::max(0.0, ahead_s);
  pose_ = {odometry->stamp, odometry->odom_frame, odometry->T_odom_base,
           T_map_odom_ * odometry->T_odom_base};
  input.T_local_base = Planar(pose_.T_odom_base);
  input.T_map_base = Planar(pose_.T_map_base);
  // Braking from a velocity that is measured no more would never end.
  if (input.now - input.pose_stamp < kFreshVelocity_s) input.velocity = odometry->velocity;
  return input;
}

void ControlLoop::Act(const NavigationInput& input, const NavigationOutput& output) {
  if (output.look_again) mapping_.LookAgain();
  if (output.forget_additions) mapping_.ForgetAdditions();
  if (input.localized) goals_.PublishFeedback(pose_.T_map_base, pose_.stamp);
  publisher_.PublishPicture(output, pose_);
  if (!output.result) return;
  std::string how = ToString(*output.result);
  if (!output.reason.empty() && output.reason != how) how += ": " + output.reason;
  ROS_INFO_STREAM("goal ended, " << how);
  goals_.Finish(*output.result, output.reason);
  const std::lock_guard<std::mutex> lock(mutex_);
  state_.last_result = how;
  if (*output.result == NavigationResult::kReached) ++state_.reached;
}

void ControlLoop::NoteLatency(const NavigationInput& input) {
  if (input.obstacles_stamp == heeded_) return;
  heeded_ = input.obstacles_stamp;
  const Time sent = odometry_.SensorTime(FromRos(ros::Time::now()));
  const std::lock_guard<std::mutex> lock(mutex_);
  latencies_.Add(1e3 * (sent - input.obstacles_stamp));
}

void ControlLoop::Note(const NavigationInput& input, const NavigationOutput& output) {
  ControlState state = this->state();
  const bool pauses = output.state == NavigationState::kPaused && output.reason != state.reason;
  if (output.state != state.state || pauses) {
    ROS_INFO_STREAM(ToString(output.state) << (output.reason.empty() ? "" : ": " + output.reason));
  }
  state.has_goal = navigator_->HasGoal();
  state.state = output.state;
  state.reason = output.reason;
  state.missing = MissingInput(input, config_.planning.navigator);
  state.remaining_m = output.remaining_m;
  state.recoveries = output.recoveries;
  state.pose_age_s = input.now - input.pose_stamp;
  state.obstacles_age_s = input.now - input.obstacles_stamp;
  state.localized = input.localized;
  state.other_clock = other_clock_;
  const std::lock_guard<std::mutex> lock(mutex_);
  state_ = state;
}

}  // namespace hv::navigation
