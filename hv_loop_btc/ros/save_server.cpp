#include "save_server.h"

#include <ros/console.h>

namespace hv::loop {
namespace {

hv_msgs::SaveMapResult ToResult(const SaveOutcome& outcome) {
  hv_msgs::SaveMapResult result;
  result.success = outcome.success;
  result.message = outcome.message;
  result.directory = outcome.map.path;
  result.points = outcome.map.points;
  result.bytes = outcome.map.bytes;
  return result;
}

void Tell(const SaveOutcome& outcome) {
  if (outcome.success) {
    ROS_INFO_STREAM("map saved in " << outcome.message);
  } else {
    ROS_ERROR_STREAM("map not saved: " << outcome.message);
  }
}

}  // namespace

SaveServer::SaveServer(ros::NodeHandle private_nh, MapSaving& saving)
    : saving_(saving),
      service_nh_(private_nh),
      spinner_(1, &service_queue_),
      action_(
          private_nh, "save_map", [this](const auto& goal) { OnGoal(goal); }, false) {
  service_nh_.setCallbackQueue(&service_queue_);
  service_ = service_nh_.advertiseService("save_map", &SaveServer::OnRequest, this);
  spinner_.start();
  action_.start();
}

SaveServer::~SaveServer() { Stop(); }

void SaveServer::Stop() {
  service_.shutdown();
  spinner_.stop();
  action_.shutdown();
}

void SaveServer::OnGoal(const hv_msgs::SaveMapGoalConstPtr& goal) {
  const SaveOutcome outcome =
      saving_.Save(goal->directory, [this](const char* stage, double share) {
        hv_msgs::SaveMapFeedback feedback;
        feedback.stage = stage;
        feedback.share = static_cast<float>(share);
        action_.publishFeedback(feedback);
        return !action_.isPreemptRequested();
      });
  Tell(outcome);
  if (outcome.success) {
    action_.setSucceeded(ToResult(outcome), outcome.message);
  } else if (action_.isPreemptRequested()) {
    action_.setPreempted(ToResult(outcome), outcome.message);
  } else {
    action_.setAborted(ToResult(outcome), outcome.message);
  }
}

bool SaveServer::OnRequest(std_srvs::TriggerRequest&, std_srvs::TriggerResponse& response) {
  const SaveOutcome outcome = saving_.Save("");
  Tell(outcome);
  response.success = outcome.success;
  response.message = outcome.message;
  return true;
}

}  // namespace hv::loop
