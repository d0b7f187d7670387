#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "hv_lio/scan_preprocessor.h"

namespace hv::lio {

/// Sums over points, relative to an origin that its owner keeps: constant memory, any number of
/// points, exact to combine and to take apart again.
struct PointSums {
  double count = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();

  /// Adds `n` points with the given mean (relative to the origin) and covariance.
  void Add(double n, const Eigen::Vector3d& mean, const Eigen::Matrix3d& scatter);
  /// Adds (sign +1) or removes (-1) sums whose origin lies at `offset` from this one's.
  void Combine(const PointSums& other, const Eigen::Vector3d& offset, double sign);
  /// Forgets all but `keep` of the weight; mean and covariance stay.
  void Fade(double keep);

  Eigen::Vector3d Mean() const { return sum / count; }
  Eigen::Matrix3d Covariance() const;
};

/// Surface primitive fitted to a voxel (paper 3.1). Positions in odom [m].
struct SurfaceFeature {
  enum class Kind : std::uint8_t { kNone, kPlane, kGaussian };
  Kind kind = Kind::kNone;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, variance descending
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();  ///< of the points along the axes [m^2]
  double offset_variance = 0.0;  ///< of the plane along its normal, at the centre [m^2]

  Eigen::Vector3d normal() const { return axes.col(2); }

  /// Variance of the plane along its normal at `point`: the tilt of the normal adds to the offset
  /// with the distance from the centre [m^2].
  double PlaneVarianceAt(const Eigen::Vector3d& point) const;

  /// Covariance of the normal [rad^2].
  Eigen::Matrix3d NormalCovariance() const;
};

/// When a voxel counts as planar, when it splits and when it settles.
struct VoxelFitConfig {
  int min_points = 10;
  double plane_sigma_m = 0.03;
  double plane_flatness = 0.1;
  double min_spread_m = 0.03;
  double scan_sigma_m = 0.004;
  int settle_scans = 50;
  int refit_percent = 5;
  double gaussian_baseline_m = 0.3;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

inline constexpr std::uint32_t kNoIndex = 0xFFFFFFFFU;

/// One cube of the map, at any layer.
struct Voxel {
  PointSums sums;  ///< relative to the centre of the root voxel's cube
  SurfaceFeature feature;
  double information = 0.0;    ///< of the plane's offset, summed over scans [1/m^2]
  double fitted_count = 0.0;   ///< points at the last fit
  Eigen::Vector3f first_seen_from = Eigen::Vector3f::Zero();  ///< sensor position, odom [m]
  std::uint32_t children = kNoIndex;  ///< block of eight, kNoIndex when not subdivided
  std::uint32_t last_scan = 0;
  std::uint16_t scans = 0;
  std::uint8_t disagreements = 0;  ///< settled voxels: recent scans that contradict the plane
  bool settled = false;
  bool seen_from_afar = false;  ///< from places at least gaussian_baseline_m apart

  bool planar() const { return feature.kind == SurfaceFeature::Kind::kPlane; }
};

/// Fits `feature` to `sums` about `origin` (odom): decides between plane and Gaussian and fills
/// axes and variances. kNone while there are fewer than min_points.
void FitFeature(const PointSums& sums, const Eigen::Vector3d& origin, double information,
                const VoxelFitConfig& config, SurfaceFeature& feature);

}  // namespace hv::lio
