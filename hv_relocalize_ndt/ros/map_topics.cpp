#include "map_topics.h"

#include <nav_msgs/OccupancyGrid.h>
#include <sensor_msgs/PointCloud2.h>

#include "hv_core/map_folder.h"
#include "hv_ros/conversions.h"
#include "hv_ros/latched.h"

namespace hv::relocalize {
namespace {

std::vector<Point> Thinned(const std::vector<Eigen::Vector3f>& cloud, double voxel_m,
                           std::size_t max_points) {
  std::vector<Point> points(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    points[i].x = cloud[i].x();
    points[i].y = cloud[i].y();
    points[i].z = cloud[i].z();
  }
  points = Decimated(points, voxel_m);
  while (points.size() > max_points) {
    voxel_m *= 2.0;
    points = Decimated(points, voxel_m);
  }
  return points;
}

}  // namespace

MapTopics::MapTopics(ros::NodeHandle nh, const LocalizationOutputConfig& config,
                     const PriorMap& map)
    : config_(config) {
  PublishCloud(nh, map);
  PublishGrid(nh, map);
}

void MapTopics::PublishCloud(ros::NodeHandle& nh, const PriorMap& map) {
  cloud_ = nh.advertise<sensor_msgs::PointCloud2>("map_cloud", 1, kLatched);
  const auto message = ToCloudMessage(Thinned(map.points(), config_.cloud_voxel_m,
                                              static_cast<std::size_t>(config_.cloud_max_points)));
  message->header.frame_id = config_.map_frame;
  cloud_.publish(message);
}

void MapTopics::PublishGrid(ros::NodeHandle& nh, const PriorMap& map) {
  const MapFolder folder = MapFolder::Open(map.name());
  if (!folder.contents().grid) return;
  grid_ = nh.advertise<nav_msgs::OccupancyGrid>("map", 1, kLatched);
  nav_msgs::OccupancyGrid message = ToGridMessage(folder.ReadGrid());
  message.header.frame_id = config_.map_frame;
  grid_.publish(message);
}

}  // namespace hv::relocalize
