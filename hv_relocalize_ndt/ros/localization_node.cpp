#include "localization_node.h"

#include <utility>

#include <ros/console.h>

#include "hv_core/config.h"
#include "pose_message.h"

namespace hv::relocalize {
namespace {

constexpr std::uint32_t kScanQueue = 10;
constexpr std::uint32_t kOdometryQueue = 100;
constexpr double kPatience = 3.0;  // without scans [s]

TransformOptions TransformsOf(const LocalizationOutputConfig& config) {
  return {config.map_frame, config.publish_tf, config.tf_tolerance_s, config.correction_s};
}

double WallSeconds() { return ros::WallTime::now().toSec(); }

}  // namespace

LocalizationNode::LocalizationNode(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : parameters_(ReadParameters(private_nh)),
      engine_(parameters_.config, parameters_.map_path),
      health_(engine_, queue_),
      transforms_(TransformsOf(parameters_.config.output)),
      publisher_(nh, parameters_.config.output),
      map_topics_(nh, parameters_.config.output, engine_.map()),
      last_scan_s_(WallSeconds()),
      diagnostics_(nh, private_nh, private_nh.getNamespace()) {
  ROS_INFO_STREAM("configuration:\n" << ToYaml(parameters_.config));
  ROS_INFO_STREAM("localising in " << engine_.map().name() << ", " << engine_.map().points().size()
                                   << " points");
  transforms_.Withdraw();
  if (parameters_.T_map_base) engine_.SetGuess({*parameters_.T_map_base});
  server_.emplace(nh, private_nh, parameters_.config, engine_);
  Advertise(nh);
  worker_ = std::thread([this] { Run(); });
}

LocalizationNode::~LocalizationNode() {
  timer_.stop();
  scan_subscriber_.shutdown();
  odometry_subscriber_.shutdown();
  server_.reset();
  queue_.Close();
  if (worker_.joinable()) worker_.join();
}

void LocalizationNode::Advertise(ros::NodeHandle nh) {
  diagnostics_.setHardwareID("none");
  diagnostics_.add("localisation", &health_, &LocalizationHealth::DescribeLocalization);
  diagnostics_.add("map", &health_, &LocalizationHealth::DescribeMap);
  scan_subscriber_ = nh.subscribe("tracked_scan", kScanQueue, &LocalizationNode::OnScan, this);
  odometry_subscriber_ = nh.subscribe("odometry", kOdometryQueue, &LocalizationNode::OnOdometry,
                                      this, ros::TransportHints().tcpNoDelay());
  timer_ = nh.createWallTimer(ros::WallDuration(1.0), [this](const auto&) { OnTimer(); });
}

void LocalizationNode::OnScan(const hv_msgs::TrackedScanConstPtr& message) {
  last_scan_s_ = WallSeconds();
  DecodedTrackedScan scan = FromMessage(*message);
  if (!scan.error.empty()) {
    ROS_WARN_STREAM_THROTTLE(5.0, "scan not usable: " << scan.error);
    health_.OnUnusable(scan.error);
    return;
  }
  queue_.Push(std::move(scan));
}

void LocalizationNode::OnOdometry(const nav_msgs::OdometryConstPtr& message) {
  transforms_.OnOdometry(*message);
}

/// One line, or nothing.
std::string LocalizationNode::ProblemOfInput() const {
  if (scan_subscriber_.getNumPublishers() == 0) {
    return "nobody publishes " + scan_subscriber_.getTopic();
  }
  if (parameters_.config.output.publish_tf && odometry_subscriber_.getNumPublishers() == 0) {
    return "nobody publishes " + odometry_subscriber_.getTopic() + ": no map -> odom";
  }
  const double silent = WallSeconds() - last_scan_s_;
  if (silent < kPatience) return "";
  return "no scan for " + std::to_string(static_cast<int>(silent)) + " s";
}

void LocalizationNode::OnTimer() {
  health_.SetProblem(ProblemOfInput());
  diagnostics_.force_update();
}

void LocalizationNode::Run() {
  while (const std::optional<ScanBatch> batch = queue_.Pop()) {
    const LocalizationReport report = engine_.Add(*batch);
    UpdateTransform(report.update);
    publisher_.Publish(report, batch->points);
    ReportChanges(report);
  }
}

void LocalizationNode::UpdateTransform(const LocalizerUpdate& update) {
  if (update.state == LocalizerState::kLost) {
    transforms_.Withdraw();
  } else if (update.registered) {
    transforms_.Update(update.T_map_odom, update.found);
  }
}

void LocalizationNode::ReportChanges(const LocalizationReport& report) {
  const LocalizerUpdate& update = report.update;
  const bool lost = update.state == LocalizerState::kLost;
  if (update.found) ROS_INFO_STREAM("localised at " << PlaceOf(report.T_map_base));
  if (update.searched && !update.found && !lost) {
    ROS_WARN_STREAM("the place stays as it was, nothing fits near the guess: " << update.refusal);
  }
  if (lost && reported_ != LocalizerState::kLost) ROS_WARN_STREAM("lost: " << update.reason);
  if (lost && reported_ == LocalizerState::kLost && update.searched) {
    ROS_WARN_STREAM_THROTTLE(10.0, "still lost: " << update.reason);
  }
  if (update.state == LocalizerState::kDeadReckoning && update.state != reported_) {
    ROS_WARN_STREAM("dead reckoning: " << update.reason);
  }
  reported_ = update.state;
}

}  // namespace hv::relocalize
