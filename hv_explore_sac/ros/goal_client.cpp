#include "goal_client.h"

#include <utility>

#include "pose_message.h"

namespace hv::explore {
namespace {

constexpr bool kOwnThread = false;

}  // namespace

GoalClient::GoalClient(ros::NodeHandle nh, std::string map_frame)
    : map_frame_(std::move(map_frame)), client_(nh, "move_base", kOwnThread) {}

void GoalClient::Send(const navigation::PlanarPose& goal) {
  move_base_msgs::MoveBaseGoal message;
  message.target_pose = ToPoseStamped(goal, map_frame_);
  under_way_ = true;
  taken_over_ = false;
  outcome_.reset();
  client_.sendGoal(message, [this](const State& state, const auto&) { OnDone(state); });
}

void GoalClient::Cancel() {
  if (under_way_) client_.cancelGoal();
  under_way_ = false;
  outcome_.reset();
}

void GoalClient::OnDone(const State& state) {
  if (!std::exchange(under_way_, false)) return;
  if (state == State::PREEMPTED || state == State::RECALLED) {
    taken_over_ = true;
    return;
  }
  std::string reason = state.getText();
  if (reason.empty()) reason = state.toString();
  outcome_ = GoalOutcome{state == State::SUCCEEDED, reason};
}

std::optional<GoalOutcome> GoalClient::TakeOutcome() {
  if (under_way_ && !Ready()) {
    under_way_ = false;
    return GoalOutcome{false, "the navigation has gone"};
  }
  return std::exchange(outcome_, std::nullopt);
}

bool GoalClient::TakenOver() { return std::exchange(taken_over_, false); }

}  // namespace hv::explore
