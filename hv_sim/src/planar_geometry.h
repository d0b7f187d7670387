#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace hv::sim {

/// A rectangle with sides along the axes.
struct Rectangle {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();

  double DistanceTo(const Eigen::Vector2d& point) const;  ///< 0 inside
};

/// 0 when they touch.
double Distance(const Rectangle& rectangle, const Eigen::Vector2d& from, const Eigen::Vector2d& to);

/// To a convex polygon, its inside included; infinite when it has no corners.
double Distance(const Rectangle& rectangle, const std::vector<Eigen::Vector2d>& polygon);

/// The part of a triangle with z in [low, high], seen from above: a convex polygon, perhaps flat.
std::vector<Eigen::Vector2d> SliceOf(const std::array<Eigen::Vector3d, 3>& triangle, double low,
                                     double high);

}  // namespace hv::sim
