#pragma once

#include <cstddef>

#include "hv_core/se3.h"

namespace hv::loop {

/// An edge of the pose graph by indices of vertices.
struct Measurement {
  std::size_t from = 0;
  std::size_t to = 0;
  Pose T_from_to = Pose::Identity();
  Matrix6d information = Matrix6d::Identity();  ///< of RelativePoseResidual
};

/// The way up in the IMU frame of a vertex, a unit vector.
struct TiltMeasurement {
  std::size_t vertex = 0;
  Eigen::Vector3d up_imu = Eigen::Vector3d::UnitZ();
};

}  // namespace hv::loop
