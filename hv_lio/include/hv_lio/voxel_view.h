#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace hv::lio {

/// What a voxel contributes to the pictures of the map (paper Fig. 12).
struct VoxelView {
  enum class Kind { kPlane, kMergedPlane, kGaussian };
  Kind kind = Kind::kGaussian;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< mean of the points, odom [m]
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: principal axes, normal last
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();     ///< standard deviation along them [m]
  std::uint32_t plane_id = 0;  ///< shared by voxels of one merged plane, 0 when not merged
  double size = 0.0;           ///< edge of the voxel [m]
};

}  // namespace hv::lio
