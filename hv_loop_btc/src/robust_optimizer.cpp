#include "robust_optimizer.h"

#include <algorithm>
#include <string>

#include "graph_solver.h"
#include "hv_core/angles.h"
#include "hv_loop_btc/pose_graph_residuals.h"
#include "loop_judge.h"
#include "segment_join.h"

namespace hv::loop {
namespace {

constexpr int kMostReviews = 3;

double Threshold(const PoseGraphConfig& config, double scale) {
  return scale * scale * ChiSquareQuantile6(config.inlier_probability);
}

}  // namespace

RobustOptimizer::RobustOptimizer(const PoseGraphConfig& config, IndexedGraph& graph)
    : config_(config),
      graph_(graph),
      chains_(graph.poses.size(), graph.odometry),
      parts_(graph.poses.size()),
      threshold_(Threshold(config, config.inlier_scale)) {}

PoseGraphSummary RobustOptimizer::Run() {
  FollowOdometry(false);
  JoinParts();
  RefuseImplausible();
  DecideOnFreshLoops();
  SolveAll();
  const double initial_cost = summary_.initial_cost;
  for (int review = 0; review < kMostReviews && ReviewLoops(); ++review) SolveAll();
  summary_.initial_cost = initial_cost;
  Conclude();
  return summary_;
}

void RobustOptimizer::FollowOdometry(bool also_optimized) {
  for (const Measurement& edge : graph_.odometry) {
    if (graph_.optimized[edge.to] && !also_optimized) continue;
    graph_.poses[edge.to] = graph_.poses[edge.from] * edge.T_from_to;
  }
}

/// Loops of segments that have just been joined count as fresh, even if they waited for that.
void RobustOptimizer::JoinParts() {
  for (const Measurement& edge : graph_.odometry) parts_.Join(edge.from, edge.to);
  for (std::size_t k = 0; k < graph_.loops.size(); ++k) {
    const bool accepted = graph_.states[k] == LoopState::kAccepted;
    if (accepted) parts_.Join(graph_.loops[k].from, graph_.loops[k].to);
  }
  std::vector<std::size_t> waiting;
  for (std::size_t k = 0; k < graph_.loops.size(); ++k) {
    if (!IsConnected(graph_.loops[k])) waiting.push_back(k);
  }
  const JoinRule rule{threshold_, static_cast<std::size_t>(config_.loops_to_join_segments)};
  JoinSegments(rule, chains_, graph_.loops, parts_, graph_.poses);
  for (const std::size_t k : waiting) {
    if (IsConnected(graph_.loops[k])) graph_.states[k] = LoopState::kFresh;
  }
}

void RobustOptimizer::RefuseImplausible() {
  for (std::size_t k = 0; k < graph_.loops.size(); ++k) {
    if (graph_.states[k] != LoopState::kFresh) continue;
    const bool usable = IsConnected(graph_.loops[k]) && IsPlausible(graph_.loops[k]);
    if (!usable) graph_.states[k] = LoopState::kRefused;
  }
}

void RobustOptimizer::DecideOnFreshLoops() {
  const std::vector<Measurement> fresh = Loops(LoopState::kFresh);
  if (fresh.empty()) return;
  if (LoopsAgree(chains_, Loops(LoopState::kAccepted), fresh, threshold_, graph_.poses)) {
    std::replace(graph_.states.begin(), graph_.states.end(), LoopState::kFresh,
                 LoopState::kAccepted);
  } else {
    JudgeAllLoops();
  }
}

void RobustOptimizer::JudgeAllLoops() {
  summary_.judged_all_loops = true;
  std::vector<std::size_t> candidates;
  std::vector<Measurement> loops;
  for (std::size_t k = 0; k < graph_.loops.size(); ++k) {
    if (!IsConnected(graph_.loops[k]) || !IsPlausible(graph_.loops[k])) continue;
    candidates.push_back(k);
    loops.push_back(graph_.loops[k]);
  }
  FollowOdometry(true);
  const std::vector<bool> accepted = JudgeLoops(chains_, loops, threshold_, graph_.poses);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    graph_.states[candidates[i]] = accepted[i] ? LoopState::kAccepted : LoopState::kRefused;
  }
}

void RobustOptimizer::SolveAll() {
  GraphSolver solver(graph_.poses);
  for (const Measurement& edge : graph_.odometry) solver.AddConstraint(edge);
  for (const Measurement& loop : Loops(LoopState::kAccepted)) solver.AddConstraint(loop);
  if (config_.tilt_sigma_deg > 0.0) {
    const double sigma = kRadiansPerDegree * config_.tilt_sigma_deg;
    for (const TiltMeasurement& tilt : graph_.tilts) solver.AddTilt(tilt, sigma);
  }
  const GraphSolver::Result result =
      solver.Solve(config_.max_iterations, config_.relative_tolerance);
  graph_.poses = solver.Poses();
  summary_.converged = result.converged;
  summary_.iterations += result.iterations;
  summary_.initial_cost = result.initial_cost;
  summary_.final_cost = result.final_cost;
}

/// Judges by the solution over all keyframes. Returns whether that changes a decision.
bool RobustOptimizer::ReviewLoops() {
  bool changed = false;
  for (std::size_t k = 0; k < graph_.loops.size(); ++k) {
    const bool accepted =
        IsConnected(graph_.loops[k]) && SquaredResidual(graph_.loops[k]) <= threshold_;
    const LoopState state = accepted ? LoopState::kAccepted : LoopState::kRefused;
    changed = changed || state != graph_.states[k];
    graph_.states[k] = state;
  }
  return changed;
}

void RobustOptimizer::Conclude() {
  summary_.loops_accepted = Loops(LoopState::kAccepted).size();
  summary_.loops_refused = graph_.loops.size() - summary_.loops_accepted;
  summary_.reason = std::to_string(summary_.loops_accepted) + " of " +
                    std::to_string(graph_.loops.size()) + " loops accepted, " +
                    (summary_.converged ? "converged after " : "not converged after ") +
                    std::to_string(summary_.iterations) + " iterations";
}

/// Whether odometry can have drifted as far as the loop says, with a generous margin.
bool RobustOptimizer::IsPlausible(const Measurement& loop) const {
  if (!chains_.SameChain(loop.from, loop.to)) return true;
  const UncertainPose cycle = chains_.Between(loop.from, loop.to) *
                              Inverse(UncertainPose{loop.T_from_to, InverseOf(loop.information)});
  return SquaredDistanceFromIdentity(cycle) <= Threshold(config_, config_.odometry_gate_scale);
}

double RobustOptimizer::SquaredResidual(const Measurement& loop) const {
  const Vector6d residual =
      RelativePoseResidual(loop.T_from_to, graph_.poses[loop.from], graph_.poses[loop.to]);
  return residual.dot(loop.information * residual);
}

std::vector<Measurement> RobustOptimizer::Loops(LoopState state) const {
  std::vector<Measurement> loops;
  for (std::size_t k = 0; k < graph_.loops.size(); ++k) {
    if (graph_.states[k] == state) loops.push_back(graph_.loops[k]);
  }
  return loops;
}

}  // namespace hv::loop
