#pragma once

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_core/keyframe.h"
#include "hv_core/pose_graph_data.h"

namespace hv::loop {

struct OdometryEdgeConfig {
  double correlation = 0.9;
  double translation_sigma_m = 0.001;
  double rotation_sigma_deg = 0.003;
  double translation_drift_m = 0.002;
  double rotation_drift_deg = 0.005;
  double degenerate_translation_m = 0.2;
  double degenerate_rotation_deg = 1.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Covariance of the keyframe's pose by right-multiplied perturbation, T_odom_imu Exp(xi),
/// translation first [m^2, rad^2]. The keyframe has it in axes of odom.
Matrix6d RightCovariance(const Keyframe& keyframe);

/// Covariance of the right-multiplied error of T_from_to by first-order propagation of those of
/// both poses (paper Eq. 8-9), with the Jacobians -Ad(T_from_to^-1) and I:
///
///     (1 - c) (P + Q) + c |Q - P|,  P = Ad(T_from_to^-1) Sigma_from Ad(T_from_to^-1)^T,
///                                   Q = Sigma_to.
///
/// The paper's sum P + Q (c = 0) holds for independent poses, but both were registered to nearly
/// the same map: most of their errors is common and cancels in the relative pose. A share c
/// (`correlation`) of the variance is taken as common, so that only its change |Q - P| (absolute
/// values of eigenvalues) counts.
Matrix6d RelativeCovariance(const Pose& T_from_to, const Matrix6d& sigma_from,
                            const Matrix6d& sigma_to, double correlation);

/// Odometry edge between consecutive keyframes of one segment (InputError otherwise). The front
/// end's covariances know nothing of the drift of its map: a floor per keyframe and a random walk
/// over the distance are added, and a large variance along the directions that either scan could
/// not observe, half of it for each.
GraphEdge OdometryEdge(const OdometryEdgeConfig& config, const Keyframe& from, const Keyframe& to);

/// Direction against gravity in the IMU frame of the keyframe, for PoseGraph::AddTilt().
Eigen::Vector3d UpInImu(const Keyframe& keyframe);

}  // namespace hv::loop
