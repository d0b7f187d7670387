#include "loop_judge.h"

#include <algorithm>
#include <cmath>

#include "graph_solver.h"
#include "hv_loop_btc/pose_graph_residuals.h"
#include "skeleton.h"

namespace hv::loop {
namespace {

constexpr double kMuGrowth = 3.0;  // 1.4 in the paper; larger than 3 loses true loops
constexpr int kIterationsPerStep = 2;
constexpr int kMostSteps = 60;
constexpr int kTrialIterations = 4;
constexpr double kTolerance = 1e-3;

/// The skeleton as a least squares problem in which each loop has a weight.
class SkeletonProblem {
 public:
  SkeletonProblem(const OdometryChains& chains, const std::vector<Measurement>& loops,
                  const std::vector<Pose>& poses)
      : skeleton_(chains, loops) {
    for (const std::size_t vertex : skeleton_.vertices()) kept_.push_back(poses[vertex]);
  }

  /// Returns the cost.
  double Solve(const std::vector<double>& weights, int iterations) {
    GraphSolver solver(kept_);
    for (const Measurement& edge : skeleton_.odometry()) solver.AddConstraint(edge);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      solver.AddConstraint(skeleton_.loops()[k], weights[k]);
    }
    const double cost = solver.Solve(iterations, kTolerance).final_cost;
    kept_ = solver.Poses();
    return cost;
  }

  /// Squared Mahalanobis residuals of the loops, without weights.
  std::vector<double> SquaredResiduals() const {
    std::vector<double> squared;
    for (const Measurement& loop : skeleton_.loops()) {
      const Vector6d residual =
          RelativePoseResidual(loop.T_from_to, kept_[loop.from], kept_[loop.to]);
      squared.push_back(residual.dot(loop.information * residual));
    }
    return squared;
  }

  void Move(std::vector<Pose>& poses) const { skeleton_.Spread(kept_, poses); }

 private:
  Skeleton skeleton_;
  std::vector<Pose> kept_;
};

double Largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// Control parameter of the first step (Yang et al., remark 5).
double FirstMu(double largest_squared, double threshold) {
  constexpr double kNotConvex = 1e9;  // all residuals are small: plain truncated least squares
  const double excess = 2.0 * largest_squared - threshold;
  return excess > threshold / kNotConvex ? threshold / excess : kNotConvex;
}

/// Weight of a loop (Yang et al., Eq. 14).
double TlsWeight(double squared, double threshold, double mu) {
  if (squared >= (mu + 1.0) / mu * threshold) return 0.0;
  if (squared <= mu / (mu + 1.0) * threshold) return 1.0;
  return std::sqrt(threshold * mu * (mu + 1.0) / squared) - mu;
}

std::vector<double> TlsWeights(const std::vector<double>& squared, double threshold, double mu) {
  std::vector<double> weights(squared.size());
  std::transform(squared.begin(), squared.end(), weights.begin(),
                 [&](double value) { return TlsWeight(value, threshold, mu); });
  return weights;
}

bool AllDecided(const std::vector<double>& weights) {
  return std::all_of(weights.begin(), weights.end(),
                     [](double weight) { return weight == 0.0 || weight == 1.0; });
}

}  // namespace

std::vector<bool> JudgeLoops(const OdometryChains& chains, const std::vector<Measurement>& loops,
                             double threshold, std::vector<Pose>& poses) {
  if (loops.empty()) return {};
  SkeletonProblem problem(chains, loops, poses);
  std::vector<double> squared = problem.SquaredResiduals();
  double mu = FirstMu(Largest(squared), threshold);
  for (int step = 0; step < kMostSteps; ++step) {
    const std::vector<double> weights = TlsWeights(squared, threshold, mu);
    problem.Solve(weights, kIterationsPerStep);
    squared = problem.SquaredResiduals();
    mu *= kMuGrowth;
    if (step > 0 && AllDecided(weights)) break;
  }
  problem.Move(poses);
  std::vector<bool> accepted(squared.size());
  std::transform(squared.begin(), squared.end(), accepted.begin(),
                 [&](double value) { return value <= threshold; });
  return accepted;
}

bool LoopsAgree(const OdometryChains& chains, const std::vector<Measurement>& accepted,
                const std::vector<Measurement>& fresh, double threshold, std::vector<Pose>& poses) {
  std::vector<Measurement> loops = accepted;
  loops.insert(loops.end(), fresh.begin(), fresh.end());
  SkeletonProblem problem(chains, loops, poses);
  std::vector<double> weights(loops.size(), 0.0);
  std::fill_n(weights.begin(), accepted.size(), 1.0);
  const double cost_without = problem.Solve(weights, kTrialIterations);
  weights.assign(loops.size(), 1.0);
  const double cost_with = problem.Solve(weights, kTrialIterations);
  // One fresh loop may be as unlikely as the threshold; each further one adds what it is expected
  // to, so that many true loops do not pay for a false one.
  const double allowed = threshold + 6.0 * static_cast<double>(fresh.size() - 1);
  if (2.0 * (cost_with - cost_without) > allowed) return false;
  if (Largest(problem.SquaredResiduals()) > threshold) return false;
  problem.Move(poses);
  return true;
}

}  // namespace hv::loop
