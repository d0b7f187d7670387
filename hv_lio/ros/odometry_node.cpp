#include "odometry_node.h"

#include <filesystem>

#include <ros/console.h>
#include <ros/init.h>

#include "hv_core/config.h"
#include "hv_core/error.h"
#include "hv_ros/conversions.h"

namespace hv::lio {
namespace {

constexpr std::size_t kMaxScans = 50;   // 5 s at 10 Hz
constexpr std::size_t kMaxImu = 20000;  // 50 s at 400 Hz
constexpr std::uint32_t kCloudQueue = 100;
constexpr std::uint32_t kImuQueue = 2000;
constexpr double kWaitForImuFrame = 0.5;   // [s]
constexpr double kWaitForExtrinsic = 5.0;  // between two warnings [s]

void CreateParentFolder(const std::string& file) {
  const std::filesystem::path parent = std::filesystem::path(file).parent_path();
  std::error_code error;
  if (!parent.empty()) std::filesystem::create_directories(parent, error);
  if (error) throw InputError("save_trajectory: " + parent.string() + ": " + error.message());
}

void SetExtrinsic(const Pose& T_imu_lidar, ExtrinsicConfig& extrinsic) {
  const Eigen::Quaterniond q(T_imu_lidar.linear());
  const Eigen::Vector3d t = T_imu_lidar.translation();
  extrinsic.translation_m = {t.x(), t.y(), t.z()};
  extrinsic.rotation_xyzw = {q.x(), q.y(), q.z(), q.w()};
}

}  // namespace

OdometryNode::OdometryNode(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : parameters_(ReadParameters(private_nh)),
      queue_(kMaxScans, kMaxImu),
      predictor_(parameters_.config.odometry.imu),
      publisher_(nh, parameters_.config.output, parameters_.config.odometry.use_imu),
      cloud_watch_(nh.resolveName(parameters_.config.input.points_topic),
                   "sensor_msgs/PointCloud2"),
      imu_watch_(nh.resolveName(parameters_.config.input.imu_topic), "sensor_msgs/Imu"),
      diagnostics_(nh, private_nh, private_nh.getNamespace()) {
  if (!parameters_.save_trajectory.empty()) CreateParentFolder(parameters_.save_trajectory);
  ROS_INFO_STREAM("configuration:\n" << ToYaml(parameters_.config));
  Advertise(nh, private_nh);
  worker_ = std::thread([this] { Run(); });
}

OdometryNode::~OdometryNode() {
  stop_ = true;
  timer_.stop();
  imu_subscriber_.shutdown();
  cloud_subscriber_.shutdown();
  queue_.Close();
  if (worker_.joinable()) worker_.join();
  SaveTrajectory();
}

void OdometryNode::Advertise(ros::NodeHandle nh, ros::NodeHandle private_nh) {
  const SystemConfig& config = parameters_.config;
  diagnostics_.setHardwareID("none");
  diagnostics_.add("odometry", &health_, &Health::DescribeOdometry);
  diagnostics_.add("input", &health_, &Health::DescribeInput);
  diagnostics_.add("resources", &health_, &Health::DescribeResources);
  reset_service_ = private_nh.advertiseService("reset", &OdometryNode::OnReset, this);
  pause_service_ = private_nh.advertiseService("pause", &OdometryNode::OnPause, this);
  if (config.odometry.use_imu) {
    imu_subscriber_ = nh.subscribe(config.input.imu_topic, kImuQueue, &OdometryNode::OnImu, this,
                                   ros::TransportHints().tcpNoDelay());
  }
  cloud_subscriber_ =
      nh.subscribe(config.input.points_topic, kCloudQueue, &OdometryNode::OnCloud, this);
  timer_ = nh.createWallTimer(ros::WallDuration(1.0), [this](const auto&) { OnTimer(); });
}

void OdometryNode::OnImu(const sensor_msgs::ImuConstPtr& message) {
  imu_watch_.OnMessage();
  if (paused_) return;
  const ImuSample sample = FromRos(*message);
  queue_.Push(sample);
  if (const auto prediction = predictor_.Add(sample)) publisher_.PublishPrediction(*prediction);
  health_.OnImu(sample.stamp);
}

void OdometryNode::OnCloud(const sensor_msgs::PointCloud2ConstPtr& message) {
  cloud_watch_.OnMessage();
  if (paused_) return;
  {
    const std::lock_guard<std::mutex> lock(frame_mutex_);
    if (cloud_frame_.empty()) cloud_frame_ = message->header.frame_id;
  }
  queue_.Push(message);
  health_.OnCloud(FromRos(message->header.stamp));
}

bool OdometryNode::OnReset(std_srvs::TriggerRequest&, std_srvs::TriggerResponse& response) {
  std::shared_ptr<OdometryEngine> engine;
  {
    const std::lock_guard<std::mutex> lock(engine_mutex_);
    engine = engine_;
  }
  response.success = engine != nullptr;
  if (engine) engine->Reset();
  predictor_.Clear();
  response.message = engine ? "map and buffers forgotten, odometry goes on from the current pose"
                            : "odometry has not started yet, nothing to reset";
  return true;
}

bool OdometryNode::OnPause(std_srvs::SetBoolRequest& request, std_srvs::SetBoolResponse& response) {
  paused_ = request.data;
  response.success = true;
  response.message = request.data ? "paused: input is ignored" : "running";
  return true;
}

void OdometryNode::OnTimer() {
  cloud_watch_.Check();
  if (parameters_.config.odometry.use_imu) imu_watch_.Check();
  std::string problem = cloud_watch_.problem();
  if (problem.empty() && parameters_.config.odometry.use_imu) problem = imu_watch_.problem();
  if (paused_) problem = "paused";
  health_.SetProblem(problem);
  diagnostics_.force_update();
}

std::string OdometryNode::LidarFrame() const {
  if (!parameters_.config.output.lidar_frame.empty()) return parameters_.config.output.lidar_frame;
  const std::lock_guard<std::mutex> lock(frame_mutex_);
  return cloud_frame_;
}

std::optional<Pose> OdometryNode::WaitForExtrinsic(FrameLookup& frames) {
  const std::string& imu_frame = parameters_.config.output.imu_frame;
  while (!stop_) {
    const std::string lidar_frame = LidarFrame();
    if (const auto pose = frames.Wait(imu_frame, lidar_frame, kWaitForExtrinsic)) return pose;
    if (!stop_) {
      ROS_WARN_STREAM("waiting for tf from "
                      << imu_frame << " to "
                      << (lidar_frame.empty() ? "the frame of the clouds" : lidar_frame)
                      << " (output/extrinsic_from_tf is set)");
    }
  }
  return std::nullopt;
}

bool OdometryNode::Prepare() {
  const OutputConfig& output = parameters_.config.output;
  FrameLookup frames(stop_);
  if (output.extrinsic_from_tf) {
    const auto T_imu_lidar = WaitForExtrinsic(frames);
    if (!T_imu_lidar) return false;
    SetExtrinsic(*T_imu_lidar, parameters_.config.odometry.extrinsic);
  }
  if (output.base_frame != output.imu_frame) {
    const auto T_base_imu = frames.Wait(output.base_frame, output.imu_frame, kWaitForImuFrame);
    if (T_base_imu) publisher_.SetBaseFrame(*T_base_imu);
    ROS_INFO_STREAM("pose of " << output.imu_frame << " in " << output.base_frame << ": "
                               << (T_base_imu ? "from tf" : "not in tf, identity is used"));
  }
  publisher_.SetLidarInImu(parameters_.config.odometry.extrinsic.T_imu_lidar().translation());
  const auto engine = std::make_shared<OdometryEngine>(parameters_.config);
  const std::lock_guard<std::mutex> lock(engine_mutex_);
  engine_ = engine;
  return true;
}

void OdometryNode::Run() {
  std::optional<InputQueue::Input> input = queue_.Pop();
  if (!input || !Prepare()) return;
  for (; input; input = queue_.Pop()) Handle(*input);
  const EngineCounters counters = engine_->counters();
  for (const ScanResult& result : engine_->Finish()) Deliver(result);
}

void OdometryNode::Handle(const InputQueue::Input& input) {
  const std::vector<ScanResult> results = engine_->Process(input);
  if (!input.cloud && results.empty()) return;
  const EngineCounters counters = engine_->counters();
  ReportChanges(counters);
  for (const ScanResult& result : results) Deliver(result);
  health_.OnCounters(counters, queue_.counters());
}

void OdometryNode::Deliver(const ScanResult& result) {
  health_.OnScan(result);
  const bool has_pose =
      result.status == ScanStatus::kTracking || result.status == ScanStatus::kImuOnly;
  if (!has_pose) return;
  predictor_.Anchor(result.estimate);
  if (!parameters_.save_trajectory.empty()) {
    trajectory_.Append(result.estimate.stamp, result.estimate.T_odom_imu);
  }
  if (!ros::ok()) return;
  publisher_.PublishScan(result);
  health_.OnPublished(result);
  if (publisher_.WantsVoxels(result.estimate.stamp)) {
    const auto max = static_cast<std::size_t>(parameters_.config.output.voxels_max);
    publisher_.PublishVoxels(engine_->ViewVoxels(max), result.estimate.stamp);
  }
}

void OdometryNode::ReportChanges(const EngineCounters& counters) {
  const std::size_t faults = counters.pipeline.imu_gaps + counters.pipeline.segments();
  for (const std::string& event : engine_->TakeEvents()) {
    if (faults == faults_) ROS_INFO_STREAM(event);
    if (faults != faults_) ROS_WARN_STREAM_THROTTLE(0.2, event);
  }
  faults_ = faults;
  if (counters.pipeline.segments() != segments_) predictor_.Clear();
  segments_ = counters.pipeline.segments();
  if (!time_layout_told_ && !counters.time_layout.empty()) {
    ROS_INFO_STREAM(counters.time_layout);
    time_layout_told_ = true;
  }
  if (counters.decode.clouds_unusable != unusable_) {
    ROS_WARN_STREAM_THROTTLE(5.0, "cloud not usable: " << counters.last_decode_error);
  }
  unusable_ = counters.decode.clouds_unusable;
}

void OdometryNode::SaveTrajectory() const {
  if (parameters_.save_trajectory.empty()) return;
  try {
    WriteTum(parameters_.save_trajectory, trajectory_);
    ROS_INFO_STREAM("trajectory: " << trajectory_.size() << " poses in "
                                   << parameters_.save_trajectory);
  } catch (const InputError& error) {
    ROS_ERROR_STREAM("trajectory not saved: " << error.what());
  }
}

}  // namespace hv::lio
