#pragma once

#include <vector>

#include "hv_core/pose_graph_data.h"
#include "hv_loop_btc/odometry_edge.h"

namespace hv::loop {

/// How much worse than assumed the odometry is, as loops show it. Tight odometry edges keep loops
/// from bending a map that is right; odometry that does drift must not hold on to its error. The
/// scale of its noise is therefore measured: what loops that were confirmed by others say, compared
/// with what odometry says and the noise assumed for the way between. Not thread-safe.
class OdometryScale {
 public:
  explicit OdometryScale(const OdometryEdgeConfig& config) : config_(config) {}

  /// Takes one loop: relative pose by the loop and by odometry alone, and the way between [m].
  /// Returns whether the scale has grown enough to weigh the edges anew.
  bool Observe(const Pose& T_loop, const Pose& T_odometry, double travelled_m);

  /// The edge with its noise scaled.
  GraphEdge Scaled(GraphEdge edge) const;

  double translation() const { return translation_; }
  double rotation() const { return rotation_; }

 private:
  OdometryEdgeConfig config_;
  std::vector<double> translation_ratios_;
  std::vector<double> rotation_ratios_;
  double translation_ = 1.0;
  double rotation_ = 1.0;
};

}  // namespace hv::loop
