#pragma once

#include <Eigen/Core>
#include <vector>

namespace hv::sim {

/// Points at most `step` [m] apart along a polyline whose corners are rounded by arcs of `radius`
/// [m], or of the largest radius that fits into half of the adjoining segments; 0 keeps corners.
std::vector<Eigen::Vector3d> SampleRoute(const std::vector<Eigen::Vector3d>& route, bool closed,
                                         double radius, double step);

}  // namespace hv::sim
