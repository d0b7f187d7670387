#pragma once

#include <cstddef>
#include <vector>

#include "odometry_chains.h"

namespace hv::loop {

/// The vertices that loops touch, joined by the odometry between neighbours on a chain: a small
/// graph that has the solution of the whole one, to first order.
class Skeleton {
 public:
  /// Keeps the vertices that `loops` touch and the first of each chain.
  Skeleton(const OdometryChains& chains, const std::vector<Measurement>& loops);

  /// Kept vertices by increasing index.
  const std::vector<std::size_t>& vertices() const { return vertices_; }

  /// Odometry between neighbours on a chain, by positions in vertices().
  const std::vector<Measurement>& odometry() const { return odometry_; }

  /// The loops by positions in vertices().
  const std::vector<Measurement>& loops() const { return loops_; }

  /// Moves all `poses` along with the kept ones, which have moved to `kept`: how far a kept vertex
  /// moved relative to the kept one before it is spread evenly over the vertices between.
  void Spread(const std::vector<Pose>& kept, std::vector<Pose>& poses) const;

 private:
  void FindNeighbours(const OdometryChains& chains, const std::vector<bool>& keep);
  void Connect(const OdometryChains& chains, const std::vector<Measurement>& loops);

  std::vector<std::size_t> vertices_;
  std::vector<std::size_t> positions_;  // in vertices_, of kept vertices
  std::vector<std::size_t> before_;     // of each vertex, itself or the kept one before it
  std::vector<std::size_t> after_;      // the kept one after before_; before_ if there is none
  std::vector<Measurement> odometry_;
  std::vector<Measurement> loops_;
};

}  // namespace hv::loop
