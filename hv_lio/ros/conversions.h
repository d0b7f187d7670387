#pragma once

#include <string>
#include <vector>

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Vector3.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>

#include "body_estimate.h"
#include "hv_core/imu_sample.h"
#include "hv_core/scan.h"
#include "hv_core/se3.h"
#include "hv_core/time.h"

namespace hv::lio {

/// Stamps before 1970 or after 2106, which ROS cannot hold, become the nearest it can.
ros::Time ToRos(Time stamp);
Time FromRos(const ros::Time& stamp);

ImuSample FromRos(const sensor_msgs::Imu& message);
Pose FromRos(const geometry_msgs::Transform& transform);

geometry_msgs::Pose ToPoseMessage(const Pose& pose);
geometry_msgs::Vector3 ToVectorMessage(const Eigen::Vector3d& vector);

/// Row-major 6 x 6, as geometry_msgs wants it, and exactly symmetric.
void CopyCovariance(const Matrix6d& covariance, boost::array<double, 36>& values);

/// Pose in `odom_frame`, twist in `body_frame`.
nav_msgs::Odometry ToOdometryMessage(const BodyEstimate& estimate, const std::string& odom_frame,
                                     const std::string& body_frame);

geometry_msgs::TransformStamped ToTransformMessage(const BodyEstimate& estimate,
                                                   const std::string& odom_frame,
                                                   const std::string& body_frame);

/// Points as x y z intensity (float32), one row. The header is left to the caller.
sensor_msgs::PointCloud2Ptr ToCloudMessage(const std::vector<Point>& points);

/// Points carried into another frame: p_a = T_a_b * p_b.
std::vector<Point> Transformed(const Pose& T_a_b, const std::vector<Point>& points);

/// The first point of each cube of edge `voxel_m`; all points when it is 0.
std::vector<Point> Decimated(const std::vector<Point>& points, double voxel_m);

}  // namespace hv::lio
