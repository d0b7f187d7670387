#include "map_display.h"

#include <chrono>

#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Path.h>
#include <ros/console.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/MarkerArray.h>

#include "hv_ros/conversions.h"
#include "hv_ros/latched.h"
#include "loop_markers.h"

namespace hv::loop {
namespace {

constexpr double kGridRest = 4.0;  // pause after a grid, in times of what it took

/// Ends the building of a map early.
struct Stopped {};

ros::Time NewestStamp(const LoopView& view) {
  return view.placed.empty() ? ros::Time() : ToRos(view.placed.back().stamp);
}

}  // namespace

bool MapDisplay::Topic::Wants(std::uint64_t revision) const {
  return publisher.getNumSubscribers() > 0 && sent_revision != revision &&
         ros::WallTime::now() >= next;
}

void MapDisplay::Topic::Sent(std::uint64_t revision, double pause_s) {
  sent_revision = revision;
  next = ros::WallTime::now() + ros::WallDuration(pause_s);
}

MapDisplay::MapDisplay(ros::NodeHandle nh, const MappingConfig& config, const LoopEngine& engine)
    : config_(config),
      engine_(engine),
      cloud_(config.mapping.cloud_voxel_m,
             static_cast<std::size_t>(config.mapping.cloud_max_points)) {
  path_.publisher = nh.advertise<nav_msgs::Path>("map_path", 1, kLatched);
  markers_.publisher = nh.advertise<visualization_msgs::MarkerArray>("loop_markers", 1, kLatched);
  cloud_topic_.publisher = nh.advertise<sensor_msgs::PointCloud2>("map_cloud", 1, kLatched);
  grid_.publisher = nh.advertise<nav_msgs::OccupancyGrid>("map", 1, kLatched);
  thread_ = std::thread([this] { Run(); });
}

MapDisplay::~MapDisplay() { Stop(); }

void MapDisplay::Stop() {
  stop_ = true;
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void MapDisplay::Run() {
  while (WaitForNextRound()) {
    try {
      PublishRound();
    } catch (const InputError& error) {
      ROS_WARN_STREAM_THROTTLE(10.0, "map not shown: " << error.what());
    } catch (const Stopped&) {
      return;
    }
  }
}

/// False when it is time to end.
bool MapDisplay::WaitForNextRound() {
  constexpr std::chrono::milliseconds kRound(200);
  std::unique_lock<std::mutex> lock(mutex_);
  wake_.wait_for(lock, kRound, [this] { return stop_.load(); });
  return !stop_;
}

void MapDisplay::PublishRound() {
  const LoopState state = engine_.state();
  if (state.keyframes == 0) return;
  // Waiting for all that are due together would mean one view each; one view serves them all.
  const bool path = path_.Wants(state.revision);
  const bool markers = markers_.Wants(state.revision);
  const bool cloud = cloud_topic_.Wants(state.revision);
  const bool grid = grid_.Wants(state.revision);
  if (!path && !markers && !cloud && !grid) return;
  const LoopView view = engine_.View();
  const double period = config_.mapping.display_period_s;
  if (path) {
    PublishPath(view);
    path_.Sent(state.revision, period);
  }
  if (markers) {
    markers_.publisher.publish(ToLoopMarkers(view, config_.mapping.map_frame));
    markers_.Sent(state.revision, period);
  }
  if (cloud) {
    PublishCloud(view);
    cloud_topic_.Sent(state.revision, period);
  }
  if (grid) {
    const ros::WallTime start = ros::WallTime::now();
    PublishGrid(view);
    const double took = (ros::WallTime::now() - start).toSec();
    grid_.Sent(state.revision, std::max(config_.mapping.grid_period_s, kGridRest * took));
  }
}

void MapDisplay::PublishPath(const LoopView& view) {
  nav_msgs::Path path;
  path.header.frame_id = config_.mapping.map_frame;
  path.header.stamp = NewestStamp(view);
  for (const GraphVertex& vertex : view.placed) {
    path.poses.emplace_back();
    path.poses.back().header.frame_id = path.header.frame_id;
    path.poses.back().header.stamp = ToRos(vertex.stamp);
    path.poses.back().pose = ToPoseMessage(vertex.T_map_imu);
  }
  path_.publisher.publish(path);
}

void MapDisplay::PublishCloud(const LoopView& view) {
  cloud_.Update(view.placed, [this](std::uint32_t id) { return Load(id); });
  const sensor_msgs::PointCloud2Ptr message = ToCloudMessage(cloud_.points());
  message->header.frame_id = config_.mapping.map_frame;
  message->header.stamp = NewestStamp(view);
  cloud_topic_.publisher.publish(message);
}

void MapDisplay::PublishGrid(const LoopView& view) {
  const BuiltMap built =
      MapBuilder(config_.map).Build(view.placed, [this](std::uint32_t id) { return Load(id); });
  nav_msgs::OccupancyGrid message = ToGridMessage(built.grid);
  message.header.frame_id = config_.mapping.map_frame;
  message.header.stamp = message.info.map_load_time = NewestStamp(view);
  grid_.publisher.publish(message);
}

PointCloud MapDisplay::Load(std::uint32_t id) const {
  if (stop_) throw Stopped();
  return engine_.store().Load(id);
}

}  // namespace hv::loop
