#pragma once

namespace hv::relocalize {

/// Constants of the robust likelihood of a point in a voxel: a Gaussian mixed with a uniform share
/// of outliers, whose negative logarithm is approximated by d1 exp(-d2/2 m) + d3 for the squared
/// Mahalanobis distance m (paper Eq. 23; Magnusson 2009, section 6.2). d3 shifts all poses alike.
struct RobustMixture {
  double d1 = 0.0;  ///< negative: the depth of the well
  double d2 = 0.0;  ///< its width
  double d3 = 0.0;

  /// For voxels of edge `resolution_m` and a share of outliers in (0, 1).
  static RobustMixture For(double resolution_m, double outlier_share);
};

}  // namespace hv::relocalize
