#pragma once

#include <vector>

#include "hv_core/config.h"
#include "hv_lio/nav_state.h"
#include "hv_lio/odometry_result.h"
#include "hv_lio/scan_preprocessor.h"
#include "hv_lio/voxel_map.h"

namespace hv::lio {

struct UpdateConfig {
  int max_iterations = 5;
  double convergence = 1e-3;
  double gate_sigmas = 4.0;
  double huber_sigmas = 1.5;
  double model_sigma_m = 0.02;
  double gaussian_weight = 0.5;
  double gaussian_sigma_m = 0.035;
  double information_scale = 1.0;
  double map_sigma_m = 0.0;
  double map_sigma_rad = 1e-3;
  double settling_sigma_m = 0.03;
  double settling_sigma_rad = 0.01;
  int min_residuals = 30;
  double degenerate_sigma_m = 0.1;
  double degenerate_sigma_rad = 0.02;
  double degenerate_noise_ratio = 2.0;
  double degenerate_map_sigma_m = 0.01;
  double degenerate_accel_noise = 0.02;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Iterated error-state Kalman update of a state by one scan (methods section 1). Solves the MAP
/// problem of prior and residuals by Gauss-Newton, which is the FAST-LIO form of the iterated
/// filter; associations are made anew in each iteration.
class ScanUpdate {
 public:
  explicit ScanUpdate(const UpdateConfig& config) : config_(config) {}

  /// Updates `state` and `covariance`. Leaves both alone, and says so in `residuals`, when fewer
  /// than min_residuals cells match. `settling`: velocity and tilt are still unknown, so more
  /// iterations are made and no direction is left to the IMU. Parallel with TBB; the result does
  /// not depend on the number of threads.
  UpdateSummary Apply(const std::vector<SurfaceCell>& cells, const VoxelMap& map, bool settling,
                      NavState& state, ErrorMatrix& covariance) const;

 private:
  struct Normal;

  Normal Accumulate(const std::vector<SurfaceCell>& cells, const VoxelMap& map,
                    const Pose& T_odom_imu, const Matrix6d& pose_covariance) const;
  void AddCell(const SurfaceCell& cell, const SurfaceFeature& feature, const Pose& T_odom_imu,
               const Matrix6d& pose_covariance, Normal& normal) const;
  void FindDegenerate(const Normal& normal, UpdateSummary& summary) const;
  static void AddMapNoise(double sigma_m, double sigma_rad, Normal& normal);
  static void RemoveDegenerate(const UpdateSummary& summary, Normal& normal);

  UpdateConfig config_;
};

}  // namespace hv::lio
