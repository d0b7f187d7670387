#include "relocalize_server.h"

#include <ros/console.h>
#include <ros/init.h>

#include "hv_ros/conversions.h"
#include "hv_ros/message_checks.h"
#include "pose_message.h"

namespace hv::relocalize {
namespace {

hv_msgs::RelocalizeResult ToResult(const LocalizationReport& report, const std::string& map_frame) {
  const LocalizerUpdate& update = report.update;
  hv_msgs::RelocalizeResult result;
  result.success = update.found;
  result.message = update.found ? "the robot is at " + PlaceOf(report.T_map_base)
                                : "the place was not found: " + update.refusal;
  result.reason = update.refusal;
  result.score = update.score.score();
  result.margin = update.margin;
  result.lead = update.lead;
  if (update.found) result.pose = ToPoseWithCovariance(report, map_frame);
  return result;
}

hv_msgs::RelocalizeResult Refusal(const std::string& reason) {
  hv_msgs::RelocalizeResult result;
  result.reason = result.message = reason;
  return result;
}

}  // namespace

RelocalizeServer::RelocalizeServer(ros::NodeHandle nh, ros::NodeHandle private_nh,
                                   const LocalizerConfig& config, LocalizationEngine& engine)
    : map_frame_(config.output.map_frame),
      config_(config.relocalize),
      engine_(engine),
      initial_pose_(nh.subscribe("initialpose", 5, &RelocalizeServer::OnInitialPose, this)),
      service_(private_nh.advertiseService("relocalize", &RelocalizeServer::OnRequest, this)),
      action_(
          private_nh, "relocalize", [this](const auto& goal) { OnGoal(goal); }, false) {
  action_.start();
}

RelocalizeServer::~RelocalizeServer() {
  stop_ = true;
  initial_pose_.shutdown();
  service_.shutdown();
  action_.shutdown();
}

/// What is wrong with a guess, or nothing.
std::string RelocalizeServer::ProblemOf(const std::string& frame,
                                        const geometry_msgs::Pose& pose) const {
  if (frame != map_frame_)
    return "a guess in frame '" + frame + "' instead of '" + map_frame_ + "'";
  if (!IsPose(pose)) return "a guess that is not a finite rigid transform";
  return "";
}

void RelocalizeServer::OnInitialPose(
    const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
  const std::string problem = ProblemOf(message->header.frame_id, message->pose.pose);
  if (!problem.empty()) {
    ROS_WARN_STREAM(problem << " is not used");
    return;
  }
  const PoseGuess guess = GuessFrom(message->pose, config_);
  ROS_INFO_STREAM("the next scan is looked for within " << guess.radius_m << " m of "
                                                        << PlaceOf(guess.T_map_scan));
  engine_.SetGuess(guess);
}

bool RelocalizeServer::OnRequest(std_srvs::TriggerRequest&, std_srvs::TriggerResponse& response) {
  engine_.Relocalize({});
  response.success = true;
  response.message = "the place is forgotten; the next scan is looked for in the whole map";
  return true;
}

void RelocalizeServer::OnGoal(const hv_msgs::RelocalizeGoalConstPtr& goal) {
  std::optional<PoseGuess> guess;
  if (goal->near_guess) {
    const std::string problem = ProblemOf(goal->guess.header.frame_id, goal->guess.pose);
    if (!problem.empty()) {
      action_.setAborted(Refusal(problem), problem);
      return;
    }
    guess = PoseGuess{FromRos(goal->guess.pose)};
  }
  const auto answer = WaitForAnswer(engine_.Relocalize(guess));
  if (!answer) {
    const std::string reason = "given up before there was a scan to look for";
    action_.setPreempted(Refusal(reason), reason);
    return;
  }
  const hv_msgs::RelocalizeResult result = ToResult(*answer, map_frame_);
  if (result.success) {
    action_.setSucceeded(result, result.message);
  } else {
    action_.setAborted(result, result.message);
  }
}

/// Nothing when the client gives up, or the node ends.
std::optional<LocalizationReport> RelocalizeServer::WaitForAnswer(std::uint64_t number) {
  constexpr double kFeedbackPeriod = 0.2;  // [s]
  while (!stop_ && ros::ok() && !action_.isPreemptRequested()) {
    hv_msgs::RelocalizeFeedback feedback;
    feedback.state = engine_.HasBegun(number) ? "searching" : "waiting for a scan";
    action_.publishFeedback(feedback);
    if (auto answer = engine_.Answer(number, kFeedbackPeriod)) return answer;
  }
  engine_.Cancel(number);
  return std::nullopt;
}

}  // namespace hv::relocalize
