#include "live_publisher.h"

#include <rosgraph_msgs/Clock.h>
#include <std_msgs/String.h>

#include "hv_ros/conversions.h"
#include "live_messages.h"
#include "sensor_messages.h"
#include "world_markers.h"

namespace hv::sim {
namespace {

constexpr std::uint32_t kFew = 10;
constexpr std::uint32_t kMany = 1000;

}  // namespace

LivePublisher::LivePublisher(ros::NodeHandle nh, const SimulationNodeConfig& config)
    : config_(config),
      clock_(nh.advertise<rosgraph_msgs::Clock>("/clock", kFew)),
      imu_(nh.advertise<sensor_msgs::Imu>("imu", kMany)),
      points_(nh.advertise<sensor_msgs::PointCloud2>("points", kFew)),
      depth_(nh.advertise<sensor_msgs::Image>("depth/image_rect_raw", kFew)),
      camera_info_(nh.advertise<sensor_msgs::CameraInfo>("depth/camera_info", kFew)),
      truth_(nh.advertise<nav_msgs::Odometry>("truth/odometry", kMany)),
      collision_(nh.advertise<std_msgs::String>("collision", kMany)),
      world_(nh.advertise<visualization_msgs::Marker>("world_marker", 1, true)),
      people_(nh.advertise<visualization_msgs::MarkerArray>("people", kFew)) {}

void LivePublisher::PublishWorld(const World& world, Time stamp) {
  visualization_msgs::Marker marker = WorldMarker(world.mesh, config_.world_frame);
  marker.header.stamp = ToRos(stamp);
  world_.publish(marker);
  if (!config_.publish_static_tf) return;
  std::vector<geometry_msgs::TransformStamped> transforms = StaticTransforms(config_);
  for (geometry_msgs::TransformStamped& transform : transforms) {
    transform.header.stamp = ToRos(stamp);
  }
  static_transforms_.sendTransform(transforms);
}

void LivePublisher::PublishClock(Time now) {
  rosgraph_msgs::Clock message;
  message.clock = ToRos(now);
  clock_.publish(message);
}

void LivePublisher::PublishPeople(const World& world, double time_s, Time stamp) {
  if (people_.getNumSubscribers() == 0) return;
  visualization_msgs::MarkerArray array = PeopleMarkers(world.people, time_s, config_.world_frame);
  for (visualization_msgs::Marker& marker : array.markers) marker.header.stamp = ToRos(stamp);
  people_.publish(array);
}

void LivePublisher::operator()(const ImuSample& sample) {
  sensor_msgs::Imu message = ToImuMessage(sample, config_.simulation.suite.imu);
  message.header.stamp = ToRos(sample.stamp);
  message.header.frame_id = config_.imu_frame;
  imu_.publish(message);
}

void LivePublisher::operator()(const Scan& scan) {
  sensor_msgs::PointCloud2 message = ToHesaiCloud(scan);
  message.header.stamp = ToRos(scan.stamp);
  message.header.frame_id = config_.lidar_frame;
  points_.publish(message);
}

void LivePublisher::operator()(const DepthImage& image) {
  depth_.publish(ToImageMessage(image, config_.optical_frame));
  camera_info_.publish(ToCameraInfo(config_.simulation.camera, image.stamp, config_.optical_frame));
}

void LivePublisher::operator()(const TrueState& state) {
  truth_.publish(ToOdometryMessage(state, config_.world_frame, config_.base_frame));
  if (!config_.publish_truth_tf) return;
  transforms_.sendTransform(ToTransformMessage(state, config_.world_frame, config_.base_frame));
}

void LivePublisher::operator()(const Collision& collision) {
  std_msgs::String message;
  message.data = KindOf(collision.contact);
  collision_.publish(message);
}

}  // namespace hv::sim
