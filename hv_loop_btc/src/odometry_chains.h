#pragma once

#include <cstddef>
#include <vector>

#include "measurement.h"
#include "uncertain_pose.h"

namespace hv::loop {

/// Odometry composed along each chain of keyframes: the relative pose of any two of a chain, with
/// its covariance (paper Eq. 8-9 along many edges), in constant time.
class OdometryChains {
 public:
  /// `odometry`: at most one edge to and one from each vertex, from < to.
  OdometryChains(std::size_t vertices, const std::vector<Measurement>& odometry);

  std::size_t size() const { return nodes_.size(); }

  /// First vertex of the chain of a vertex.
  std::size_t First(std::size_t vertex) const { return nodes_[vertex].first; }
  bool SameChain(std::size_t a, std::size_t b) const { return First(a) == First(b); }

  /// T_a_b by odometry alone, for two vertices of one chain in either order.
  UncertainPose Between(std::size_t a, std::size_t b) const;

 private:
  struct Node {
    std::size_t first = 0;
    Pose T_first_vertex = Pose::Identity();
    Matrix6d covariance = Matrix6d::Zero();  // of the left-multiplied error: adds up along a chain
  };
  std::vector<Node> nodes_;
};

}  // namespace hv::loop
