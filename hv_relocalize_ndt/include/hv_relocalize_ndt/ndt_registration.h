#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_core/se3.h"
#include "hv_relocalize_ndt/ndt_level.h"

namespace hv::relocalize {

struct NdtConfig {
  std::vector<double> resolutions_m = {10.0, 5.0, 3.0, 1.0};
  double outlier_share = 0.55;
  double leaf_share = 0.2;
  double min_leaf_m = 0.25;
  int max_iterations = 25;
  double converged_share = 2e-4;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// A scan prepared for the alignment at several resolutions.
class NdtSource {
 public:
  /// `points` in the frame of the scan, whose origin the sensor was at [m], any density.
  NdtSource(const NdtConfig& config, const std::vector<Eigen::Vector3f>& points);

  /// Thinned for voxels of this size.
  std::vector<Eigen::Vector3f> For(double resolution_m) const;

 private:
  const NdtConfig& config_;
  std::vector<Eigen::Vector3f> points_;
};

/// What a scan costs at a pose, with derivatives for a right perturbation (translation, then
/// rotation).
struct NdtCost {
  double cost = 0.0;  ///< negative logarithm of the likelihood without its constant; at most 0
  Vector6d gradient = Vector6d::Zero();
  Matrix6d hessian = Matrix6d::Zero();  ///< Gauss-Newton part, positive semidefinite
};

/// The cost of `source` at `T_target_source` (paper Eq. 22-23), summed over the voxels around each
/// point, so that it is smooth across their borders; faces that are turned away
/// from the sensor draw nothing.
/// Parallel, with the same result for any number of threads.
NdtCost EvaluateNdt(const NdtLevel& target, double outlier_share,
                    const std::vector<Eigen::Vector3f>& source, const Pose& T_target_source);

/// What `source` at `T_target_source` tells of its pose: the Gauss-Newton part of EvaluateNdt()'s
/// Hessian with NdtVoxel::held for the Gaussians, so that nothing counts as held that only the
/// borders of voxels hold. Right perturbation, positive semidefinite.
Matrix6d InformationOf(const NdtLevel& target, double outlier_share,
                       const std::vector<Eigen::Vector3f>& source, const Pose& T_target_source);

/// Outcome of an alignment.
struct NdtResult {
  Pose T_target_source = Pose::Identity();
  bool converged = false;
  int iterations = 0;                       ///< of all levels
  double cost_per_point = 0.0;              ///< at the finest level; levels cannot be compared
  Matrix6d information = Matrix6d::Zero();  ///< InformationOf() at the finest level
};

/// Covariance of the pose that an alignment has found, of a right perturbation. `scale`: for points
/// that err alike (RelocalizeConfig::covariance_scale). Directions that nothing holds get a large
/// one.
Matrix6d CovarianceOf(const NdtResult& result, double scale);

/// Aligns clouds to a map of Gaussians, coarse to fine, each level from the solution of the one
/// before, by Levenberg-Marquardt on SE(3) (paper 3.4). Immutable; safe to call concurrently.
class NdtRegistration {
 public:
  explicit NdtRegistration(const NdtConfig& config) : config_(config) {}

  /// `levels`: coarse to fine.
  NdtResult Align(const std::vector<const NdtLevel*>& levels, const NdtSource& source,
                  const Pose& T_target_source_guess) const;

  const NdtConfig& config() const { return config_; }

 private:
  void AlignLevel(const NdtLevel& level, const std::vector<Eigen::Vector3f>& source,
                  NdtResult& result) const;

  NdtConfig config_;
};

}  // namespace hv::relocalize
