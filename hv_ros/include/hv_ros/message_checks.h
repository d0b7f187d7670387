#pragma once

#include <string>
#include <vector>

#include <geometry_msgs/Pose.h>
#include <nav_msgs/OccupancyGrid.h>
#include <sensor_msgs/PointCloud2.h>
#include <Eigen/Core>

#include "hv_core/occupancy_grid.h"
#include "hv_core/scan.h"

/// Reading messages that anybody may have sent: nothing in them is trusted. All functions are pure.
namespace hv {

/// Of a message with members x, y, z; nothing is checked.
template <typename Message>
Eigen::Vector3d ToVector(const Message& message) {
  return {message.x, message.y, message.z};
}

/// Whether it is finite and its quaternion of length 1.
bool IsPose(const geometry_msgs::Pose& pose);

/// Appends the points of a cloud with float32 fields x, y, z and perhaps intensity; those that are
/// not finite are left out. Returns what is wrong with the cloud in one line, or nothing.
std::string ReadPoints(const sensor_msgs::PointCloud2& cloud, std::vector<Point>& points);

/// Returns what is wrong with a grid in one line, or nothing. Grids that are turned are refused.
std::string ReadGrid(const nav_msgs::OccupancyGrid& message, OccupancyGrid& grid);

}  // namespace hv
