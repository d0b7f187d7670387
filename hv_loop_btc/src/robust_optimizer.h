#pragma once

#include <cstddef>
#include <vector>

#include "disjoint_sets.h"
#include "hv_loop_btc/pose_graph.h"
#include "measurement.h"
#include "odometry_chains.h"

namespace hv::loop {

enum class LoopState { kFresh, kAccepted, kRefused };

/// A pose graph by indices.
struct IndexedGraph {
  std::vector<Pose> poses;
  std::vector<bool> optimized;        ///< the pose comes from an earlier optimisation
  std::vector<Measurement> odometry;  ///< by increasing `to`
  std::vector<Measurement> loops;
  std::vector<LoopState> states;  ///< of the loops
  std::vector<TiltMeasurement> tilts;
};

/// One robust optimisation of a graph, in place: decides about the loops on the skeleton, then
/// solves for all poses with the accepted ones.
class RobustOptimizer {
 public:
  RobustOptimizer(const PoseGraphConfig& config, IndexedGraph& graph);

  /// To be called once. Leaves every loop accepted or refused.
  PoseGraphSummary Run();

 private:
  void FollowOdometry(bool also_optimized);
  void JoinParts();
  void RefuseImplausible();
  void DecideOnFreshLoops();
  void JudgeAllLoops();
  void SolveAll();
  bool ReviewLoops();
  void Conclude();

  bool IsConnected(const Measurement& loop) {
    return parts_.First(loop.from) == parts_.First(loop.to);
  }
  bool IsPlausible(const Measurement& loop) const;
  double SquaredResidual(const Measurement& loop) const;
  std::vector<Measurement> Loops(LoopState state) const;

  const PoseGraphConfig& config_;
  IndexedGraph& graph_;
  OdometryChains chains_;
  DisjointSets parts_;  // vertices joined by odometry or by loops that may be used
  double threshold_;    // squared Mahalanobis residual of a loop
  PoseGraphSummary summary_;
};

}  // namespace hv::loop
