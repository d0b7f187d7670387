#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_core/se3.h"

namespace hv::loop {

struct RegistrationConfig {
  double coarse_voxel_m = 1.0;
  double fine_voxel_m = 0.5;
  double source_leaf_m = 0.4;
  int max_iterations = 30;
  double inlier_m = 0.1;
  double min_fitness = 0.45;
  double max_seen_through = 0.04;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Outcome of the alignment of two clouds.
struct RegistrationResult {
  Pose T_target_source = Pose::Identity();
  bool converged = false;
  int iterations = 0;
  /// Share of the source points in the part of the target that is known which lie on its surfaces
  /// (within RegistrationConfig::inlier_m), in [0, 1]; floors and ceilings, which fit anywhere, do
  /// not count.
  double fitness = 0.0;
  double overlap = 0.0;  ///< share of the source points in the part of the target that is known
  /// Share of the points of either cloud that the other sees through, of those in its view.
  /// Beyond RegistrationConfig::max_seen_through the alignment is given up and nothing else filled.
  double seen_through = 0.0;
  double rmse_m = 0.0;                      ///< of the points that lie on surfaces, across these
  Matrix6d information = Matrix6d::Zero();  ///< of T_target_source, right perturbation, t then r
};

/// Fine alignment of submaps (methods section 2, step 7): source points against Gaussians fitted to
/// the voxels of the target, coarse to fine, Gauss-Newton on SE(3) with a robust weight. Planes pull
/// across themselves only, and only points that were seen from the same side.
class SubmapRegistration {
 public:
  explicit SubmapRegistration(const RegistrationConfig& config) : config_(config) {}

  /// Points in the frames of the submaps, whose origins the sensor was at; `source_up` points
  /// against gravity. Safe to call from several threads.
  RegistrationResult Align(const std::vector<Eigen::Vector3f>& target,
                           const std::vector<Eigen::Vector3f>& source,
                           const Eigen::Vector3d& source_up,
                           const Pose& T_target_source_guess) const;

  const RegistrationConfig& config() const { return config_; }

 private:
  RegistrationConfig config_;
};

}  // namespace hv::loop
