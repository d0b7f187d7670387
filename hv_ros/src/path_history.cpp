#include "hv_ros/path_history.h"

#include <algorithm>

#include "hv_ros/conversions.h"

namespace hv {
namespace {

double Distance(const geometry_msgs::Point& a, const Eigen::Vector3d& b) {
  return (Eigen::Vector3d(a.x, a.y, a.z) - b).norm();
}

}  // namespace

PathHistory::PathHistory(double min_distance, std::size_t max_poses)
    : min_distance_(min_distance), max_poses_(std::max<std::size_t>(max_poses, 2)) {}

bool PathHistory::Add(Time stamp, const Pose& pose) {
  auto& poses = path_.poses;
  if (!poses.empty() && ToRos(stamp) < poses.back().header.stamp) poses.clear();
  if (!poses.empty() && Distance(poses.back().pose.position, pose.translation()) < min_distance_) {
    return false;
  }
  if (poses.size() >= max_poses_) DropEverySecond();
  poses.emplace_back();
  poses.back().header.stamp = ToRos(stamp);
  poses.back().pose = ToPoseMessage(pose);
  return true;
}

nav_msgs::Path PathHistory::ToMessage(const std::string& frame) const {
  nav_msgs::Path path = path_;
  path.header.frame_id = frame;
  if (!path.poses.empty()) path.header.stamp = path.poses.back().header.stamp;
  for (auto& pose : path.poses) pose.header.frame_id = frame;
  return path;
}

void PathHistory::DropEverySecond() {
  auto& poses = path_.poses;
  for (std::size_t i = 0; 2 * i < poses.size(); ++i) poses[i] = poses[2 * i];
  poses.resize((poses.size() + 1) / 2);
  min_distance_ *= 2.0;
}

}  // namespace hv
