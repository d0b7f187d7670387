#include "hv_lio/residual.h"

#include <algorithm>

namespace hv::lio {
namespace {

/// Variance of a cell's mean along a unit direction of its own frame.
double CellVariance(const SurfaceCell& cell, const Eigen::Vector3d& direction) {
  const double expected = direction.dot(cell.noise * direction);
  const double observed = direction.dot(cell.scatter * direction);
  return std::max(expected, observed) / cell.count;
}

Residual Project(const SurfaceCell& cell, const Eigen::Vector3d& direction,
                 const Eigen::Vector3d& origin, const Pose& T_odom_imu) {
  Residual residual;
  const Eigen::Vector3d in_imu = T_odom_imu.linear().transpose() * direction;
  residual.value = direction.dot(T_odom_imu * cell.mean - origin);
  residual.variance = CellVariance(cell, in_imu);
  residual.jacobian.head<3>() = direction;
  residual.jacobian.tail<3>() = cell.mean.cross(in_imu);
  return residual;
}

}  // namespace

Residual PlaneResidual(const SurfaceCell& cell, const SurfaceFeature& plane,
                       const Pose& T_odom_imu) {
  Residual residual = Project(cell, plane.normal(), plane.center, T_odom_imu);
  residual.variance += plane.PlaneVarianceAt(T_odom_imu * cell.mean);
  return residual;
}

Residual GaussianResidual(const SurfaceCell& cell, const SurfaceFeature& gaussian, int axis,
                          const Pose& T_odom_imu) {
  Residual residual = Project(cell, gaussian.axes.col(axis), gaussian.center, T_odom_imu);
  residual.variance += gaussian.variance[axis];
  return residual;
}

}  // namespace hv::lio
