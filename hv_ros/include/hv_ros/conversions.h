#pragma once

#include <vector>

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Vector3.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/time.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>

#include "hv_core/imu_sample.h"
#include "hv_core/occupancy_grid.h"
#include "hv_core/scan.h"
#include "hv_core/se3.h"
#include "hv_core/time.h"

/// Between the vocabulary of hv_core and ROS messages. All functions are pure.
namespace hv {

/// Stamps before 1970 or after 2106, which ROS cannot hold, become the nearest it can.
ros::Time ToRos(Time stamp);
Time FromRos(const ros::Time& stamp);

ImuSample FromRos(const sensor_msgs::Imu& message);

/// Quaternions are normalised; nothing else is checked.
Pose FromRos(const geometry_msgs::Transform& transform);
Pose FromRos(const geometry_msgs::Pose& pose);

geometry_msgs::Pose ToPoseMessage(const Pose& pose);
geometry_msgs::Transform ToTransform(const Pose& pose);
geometry_msgs::Vector3 ToVectorMessage(const Eigen::Vector3d& vector);
geometry_msgs::Point ToPointMessage(const Eigen::Vector3d& point);

/// Row-major 6 x 6, as geometry_msgs wants it, and exactly symmetric.
void CopyCovariance(const Matrix6d& covariance, boost::array<double, 36>& values);

/// Points as x y z intensity (float32), one row. The header is left to the caller.
sensor_msgs::PointCloud2Ptr ToCloudMessage(const std::vector<Point>& points);

/// The header is left to the caller.
nav_msgs::OccupancyGrid ToGridMessage(const OccupancyGrid& grid);

/// Points carried into another frame: p_a = T_a_b * p_b.
std::vector<Point> Transformed(const Pose& T_a_b, const std::vector<Point>& points);

/// The first point of each cube of edge `voxel_m`; all points when it is 0.
std::vector<Point> Decimated(const std::vector<Point>& points, double voxel_m);

}  // namespace hv
