#include "mapping_worker.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include <ros/console.h>

#include "depth_message.h"
#include "hv_core/elapsed.h"
#include "hv_core/error.h"

namespace hv::navigation {
namespace {

/// The LiDAR with the axes of the IMU, in which tracked scans come.
std::vector<Point> AboutLidar(const DecodedTrackedScan& scan) {
  const Eigen::Vector3f lidar = scan.header.lidar_in_imu.cast<float>();
  std::vector<Point> points = scan.points;
  for (Point& point : points) {
    point.x -= lidar.x();
    point.y -= lidar.y();
    point.z -= lidar.z();
  }
  return points;
}

}  // namespace

MappingWorker::MappingWorker(ros::NodeHandle nh, const NavigationConfig& config,
                             std::optional<OccupancyGrid> prior, const tf2_ros::Buffer& transforms,
                             const OdometryBuffer& odometry)
    : config_(config),
      transforms_(transforms),
      odometry_(odometry),
      publisher_(nh, config.node),
      jumps_(config.node.place_jump_m, config.node.place_jump_deg * M_PI / 180.0),
      surroundings_(config.mapping, config.planning.NeededClearance(), std::move(prior)),
      view_(surroundings_.view()) {
  if (view_.map) publisher_.PublishFirstMap(*view_.map);
  worker_ = std::thread([this] { Run(); });
}

MappingWorker::~MappingWorker() {
  queue_.Close();
  if (worker_.joinable()) worker_.join();
}

SurroundingsView MappingWorker::view() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return view_;
}

MappingCounters MappingWorker::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  MappingCounters counters = counters_;
  counters.queue = queue_.counters();
  return counters;
}

void MappingWorker::Save(const std::string& folder) const {
  const SurroundingsView now = view();
  if (!now.map) throw InputError("nothing has been seen yet");
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder + ": " + error.message());
  WriteGrid(folder, "grid", now.map->grid());
  const std::lock_guard<std::mutex> lock(mapping_mutex_);
  surroundings_.obstacle_map().WriteBinary(folder + "/occupancy.bt");
}

void MappingWorker::Run() {
  while (const std::optional<SensorInput> input = queue_.Pop()) Handle(*input);
}

void MappingWorker::ForgetWhatIsAsked() {
  const std::lock_guard<std::mutex> lock(mapping_mutex_);
  if (forget_.exchange(false)) surroundings_.ForgetObstacles();
  if (look_again_.exchange(false)) surroundings_.LookAgain();
  if (forget_additions_.exchange(false)) surroundings_.ForgetAdditions();
}

/// Images first, so that the grids made of the scan have them in.
void MappingWorker::Handle(const SensorInput& input) {
  ForgetWhatIsAsked();
  if (input.image) TakeImage(*input.image, *input.camera);
  if (input.scan) TakeScan(*input.scan);
  const std::lock_guard<std::mutex> lock(mutex_);
  view_ = surroundings_.view();
}

void MappingWorker::Refuse(std::size_t MappingCounters::*counter, const std::string& error) {
  ROS_WARN_STREAM_THROTTLE(5.0, error);
  const std::lock_guard<std::mutex> lock(mutex_);
  ++(counters_.*counter);
  counters_.last_error = error;
}

void MappingWorker::TakeScan(const hv_msgs::TrackedScan& message) {
  const auto start = std::chrono::steady_clock::now();
  const DecodedTrackedScan scan = FromMessage(message);
  if (!scan.error.empty()) {
    return Refuse(&MappingCounters::scans_unusable, "scan not usable: " + scan.error);
  }
  if (scan.points.empty()) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counters_.scans_without_points;
    return;
  }
  AddScan(scan);
  const double elapsed_ms = MillisecondsSince(start);
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counters_.scans;
  counters_.scan_ms = elapsed_ms;
  counters_.longest_scan_ms = std::max(counters_.longest_scan_ms, elapsed_ms);
  counters_.nodes = surroundings_.obstacle_map().node_count();
  counters_.cells_left_out = surroundings_.cells_left_out();
}

void MappingWorker::AddScan(const DecodedTrackedScan& scan) {
  const TrackedScanHeader& header = scan.header;
  const std::optional<Pose> T_map_odom =
      PlaceOfOdometry(transforms_, config_.node.map_frame, header.odom_frame, header.stamp,
                      config_.node.place_timeout_s);
  const Pose T_odom_base = header.T_odom_imu * header.T_imu_base;
  {
    const std::lock_guard<std::mutex> lock(mapping_mutex_);
    ForgetWhatIsWrong(header, T_map_odom);
    surroundings_.AddScan(header.stamp, AboutLidar(scan),
                          header.T_odom_imu * Eigen::Translation3d(header.lidar_in_imu),
                          T_odom_base);
    surroundings_.Update(T_odom_base, T_map_odom);
  }
  publisher_.Publish(surroundings_.view(), header);
}

/// Odometry that began anew, a clock that jumped, a place that was wrong.
void MappingWorker::ForgetWhatIsWrong(const TrackedScanHeader& scan,
                                      const std::optional<Pose>& T_map_odom) {
  const bool new_segment = segment_ && *segment_ != scan.segment;
  const bool clock_jumped = last_scan_ && scan.stamp < *last_scan_;
  segment_ = scan.segment;
  last_scan_ = scan.stamp;
  if (new_segment || clock_jumped) {
    ROS_WARN("odometry or its clock began anew: obstacles around the robot are forgotten");
    surroundings_.ForgetObstacles();
  }
  if (!T_map_odom || !jumps_.Add(scan.stamp, *T_map_odom, scan.T_odom_imu * scan.T_imu_base)) {
    return;
  }
  ROS_WARN("the place in the map was corrected: what was seen of the map is forgotten");
  surroundings_.ForgetViews();
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counters_.place_jumps;
}

void MappingWorker::TakeImage(const sensor_msgs::Image& message,
                              const sensor_msgs::CameraInfo& camera) {
  const auto start = std::chrono::steady_clock::now();
  const DecodedDepth depth = FromMessages(message, camera);
  if (!depth.error.empty()) {
    return Refuse(&MappingCounters::images_unusable, "depth image not usable: " + depth.error);
  }
  const std::optional<OdometryState> odometry = odometry_.Newest();
  const std::optional<Pose> T_odom_base = odometry_.PoseAt(depth.image.stamp);
  if (!odometry || !T_odom_base) {
    return Refuse(&MappingCounters::images_without_pose, "no odometry at a depth image");
  }
  const std::string& frame = message.header.frame_id;
  const auto T_base_optical = NewestTransform(transforms_, odometry->base_frame, frame);
  if (!T_base_optical) {
    return Refuse(&MappingCounters::images_without_pose,
                  "tf does not know the camera: " + odometry->base_frame + " -> '" + frame + "'");
  }
  {
    const std::lock_guard<std::mutex> lock(mapping_mutex_);
    surroundings_.AddDepth(depth.image, depth.camera, *T_odom_base * T_base_optical->T_parent_child,
                           *T_odom_base);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counters_.images;
  counters_.image_ms = MillisecondsSince(start);
}

}  // namespace hv::navigation
