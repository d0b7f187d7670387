#include "navigation_node.h"

#include <ros/console.h>

#include "hv_core/config.h"
#include "hv_core/error.h"
#include "hv_ros/conversions.h"

namespace hv::navigation {
namespace {

constexpr std::uint32_t kFew = 2;
constexpr std::uint32_t kOdometryQueue = 1000;

}  // namespace

NavigationNode::NavigationNode(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : parameters_(ReadParameters(private_nh)),
      listener_(transforms_, nh),
      mapping_(nh, parameters_.config, ReadPriorGrid(parameters_.map_path), transforms_, odometry_),
      control_(nh, parameters_.config, transforms_, odometry_, mapping_),
      health_(control_, mapping_, odometry_),
      diagnostics_(nh, private_nh, private_nh.getNamespace()) {
  ROS_INFO_STREAM("configuration:\n" << ToYaml(parameters_.config));
  ROS_INFO_STREAM((parameters_.map_path.empty() ? "the map grows from what is seen"
                                                : "planning in " + parameters_.map_path));
  Advertise(nh, private_nh);
}

NavigationNode::~NavigationNode() {
  timer_.stop();
  scan_subscriber_.shutdown();
  image_subscriber_.shutdown();
}

void NavigationNode::Advertise(ros::NodeHandle nh, ros::NodeHandle private_nh) {
  diagnostics_.setHardwareID("none");
  diagnostics_.add("navigation", &health_, &NavigationHealth::DescribeNavigation);
  diagnostics_.add("obstacles", &health_, &NavigationHealth::DescribeMapping);
  clear_service_ = private_nh.advertiseService("clear_obstacles", &NavigationNode::OnClear, this);
  save_service_ = private_nh.advertiseService("save_map", &NavigationNode::OnSave, this);
  scan_subscriber_ = nh.subscribe("tracked_scan", kFew, &NavigationNode::OnScan, this);
  odometry_subscriber_ = nh.subscribe("odometry_imu", kOdometryQueue, &NavigationNode::OnOdometry,
                                      this, ros::TransportHints().tcpNoDelay());
  camera_subscriber_ = nh.subscribe("depth/camera_info", kFew, &NavigationNode::OnCamera, this);
  image_subscriber_ = nh.subscribe("depth/image_rect_raw", kFew, &NavigationNode::OnImage, this);
  timer_ = nh.createWallTimer(ros::WallDuration(1.0), [this](const auto&) { OnTimer(); });
}

void NavigationNode::OnOdometry(const nav_msgs::OdometryConstPtr& message) {
  if (odometry_.Add(*message, FromRos(ros::Time::now()))) return;
  ROS_WARN_THROTTLE(5.0, "odometry that is not finite is not used");
}

void NavigationNode::OnImage(const sensor_msgs::ImageConstPtr& message) {
  if (!camera_) {
    ROS_WARN_STREAM_THROTTLE(5.0, "depth images wait for " << camera_subscriber_.getTopic());
    return;
  }
  mapping_.queue().Push(message, camera_);
}

bool NavigationNode::OnClear(std_srvs::TriggerRequest&, std_srvs::TriggerResponse& response) {
  mapping_.ForgetObstacles();
  response.success = true;
  response.message = "the obstacles around the robot are forgotten with the next scan";
  return true;
}

bool NavigationNode::OnSave(std_srvs::TriggerRequest&, std_srvs::TriggerResponse& response) {
  try {
    if (parameters_.save_folder.empty()) throw InputError("~save_folder is not set");
    mapping_.Save(parameters_.save_folder);
    response.success = true;
    response.message = "grid.pgm, grid.yaml and occupancy.bt are in " + parameters_.save_folder;
  } catch (const InputError& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

void NavigationNode::OnTimer() {
  std::string problem;
  for (const ros::Subscriber* subscriber : {&scan_subscriber_, &odometry_subscriber_}) {
    if (subscriber->getNumPublishers() == 0) problem = "nobody publishes " + subscriber->getTopic();
  }
  health_.SetProblem(problem);
  diagnostics_.force_update();
}

}  // namespace hv::navigation
