#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "hv_core/keyframe.h"
#include "hv_core/pose_graph_data.h"
#include "hv_loop_btc/odometry_edge.h"

namespace hv::loop {

/// Error of odometry that is the same in every metre: what a wrong scale, or a bias that follows
/// the motion, makes of it.
struct SystematicDrift {
  double stretch = 0.0;            ///< correction of distances, share
  double heading_rad_per_m = 0.0;  ///< correction of the heading about the vertical

  /// The step with the drift taken out. `up_from`: unit vector against gravity in the frame that
  /// the step starts from.
  Pose Correct(const Pose& step, const Eigen::Vector3d& up_from) const;
};

/// What confirmed loops tell about odometry: its systematic drift and how noisy it really is. Tight
/// odometry edges keep loops from bending a map that is right; odometry that does drift must not
/// hold on to its error, and an error that is the same everywhere is better taken out than shared
/// out. Not thread-safe.
class OdometryModel {
 public:
  explicit OdometryModel(const OdometryEdgeConfig& config) : config_(config) {}

  /// Keyframes in order of time.
  void AddKeyframe(const Keyframe& keyframe);

  /// A loop. Those between segments, or to keyframes of a loaded map, tell nothing.
  void AddLoop(std::uint32_t from, std::uint32_t to, const Pose& T_from_to);

  /// Learns from all loops so far. Returns whether the edges are worth weighing anew.
  bool Learn();

  /// The edge without systematic drift and with its noise scaled. An edge from a keyframe that was
  /// not added, of a loaded map, is as good as it was saved.
  GraphEdge Corrected(GraphEdge edge) const;

  /// How far odometry is off at most after a way, by what loops have shown [m]; 0 while they are
  /// too few to tell, and when it is so much that other places may look alike.
  double ExpectedError(double way_m) const;

  const SystematicDrift& drift() const { return drift_; }
  double translation_scale() const { return translation_scale_; }  ///< of the noise assumed
  double rotation_scale() const { return rotation_scale_; }

 private:
  struct Node {
    Pose T_odom_imu = Pose::Identity();
    Eigen::Vector3d up_imu = Eigen::Vector3d::UnitZ();
    double travelled_m = 0.0;
    std::uint32_t segment = 0;
  };
  struct Loop {
    std::size_t from = 0;
    std::size_t to = 0;
    Pose T_from_to = Pose::Identity();
  };
  /// Robust sum of squares and what a Gauss-Newton step needs of it.
  struct Fit {
    double cost = 0.0;
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  };

  std::vector<Pose> Chain(const SystematicDrift& drift) const;
  std::vector<Vector6d> Residuals(const SystematicDrift& drift) const;
  Fit Linearize(const SystematicDrift& drift) const;
  SystematicDrift FitDrift() const;
  bool MeasureNoise();
  double Way(const Loop& loop) const;

  OdometryEdgeConfig config_;
  std::vector<Node> nodes_;
  std::map<std::uint32_t, std::size_t> index_;
  std::vector<Loop> loops_;
  SystematicDrift drift_;
  double translation_scale_ = 1.0;
  double rotation_scale_ = 1.0;
};

}  // namespace hv::loop
