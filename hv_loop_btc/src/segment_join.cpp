#include "segment_join.h"

#include <algorithm>
#include <map>
#include <utility>

namespace hv::loop {
namespace {

constexpr std::size_t kMostHypotheses = 50;

using LoopList = std::vector<Measurement>;

struct Hypothesis {
  Measurement loop;
  std::size_t support = 0;  ///< loops that agree, itself included
};

/// The same loop, seen from its vertex of the earlier chain.
Measurement FromEarlierChain(const Measurement& loop, const OdometryChains& chains) {
  if (chains.First(loop.from) < chains.First(loop.to)) return loop;
  const UncertainPose reverse = Inverse({loop.T_from_to, InverseOf(loop.information)});
  return {loop.to, loop.from, reverse.T_a_b, InverseOf(reverse.covariance)};
}

UncertainPose Uncertain(const Measurement& loop) {
  return {loop.T_from_to, InverseOf(loop.information)};
}

/// Squared Mahalanobis distance of the cycle: one loop, odometry, the other loop, odometry.
double Disagreement(const Measurement& a, const Measurement& b, const OdometryChains& chains) {
  return SquaredDistanceFromIdentity(Uncertain(a) * chains.Between(a.to, b.to) *
                                     Inverse(Uncertain(b)) * chains.Between(b.from, a.from));
}

Hypothesis BestHypothesis(const LoopList& loops, double threshold, const OdometryChains& chains) {
  const std::size_t stride = loops.size() / kMostHypotheses + 1;
  Hypothesis best;
  for (std::size_t k = 0; k < loops.size(); k += stride) {
    const auto agrees = [&](const Measurement& loop) {
      return Disagreement(loops[k], loop, chains) <= threshold;
    };
    const auto support =
        static_cast<std::size_t>(std::count_if(loops.begin(), loops.end(), agrees));
    if (support > best.support) best = {loops[k], support};
  }
  return best;
}

/// Of all pairs of unconnected chains, the hypothesis with most support.
Hypothesis BestJoin(const JoinRule& rule, const OdometryChains& chains, const LoopList& loops,
                    DisjointSets& parts) {
  std::map<std::pair<std::size_t, std::size_t>, LoopList> by_chains;
  for (const Measurement& loop : loops) {
    if (parts.First(loop.from) == parts.First(loop.to)) continue;
    const Measurement turned = FromEarlierChain(loop, chains);
    by_chains[{chains.First(turned.from), chains.First(turned.to)}].push_back(turned);
  }
  Hypothesis best;
  for (const auto& [pair, list] : by_chains) {
    const Hypothesis hypothesis = BestHypothesis(list, rule.threshold, chains);
    if (hypothesis.support > best.support) best = hypothesis;
  }
  return best;
}

/// Moves the later part to where the loop puts it, and joins it.
void Join(Measurement loop, DisjointSets& parts, std::vector<Pose>& poses) {
  Pose T_from_to = loop.T_from_to;
  if (parts.First(loop.from) > parts.First(loop.to)) {
    std::swap(loop.from, loop.to);
    T_from_to = T_from_to.inverse();
  }
  const Pose T_new_old = poses[loop.from] * T_from_to * poses[loop.to].inverse();
  const std::size_t moved = parts.First(loop.to);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (parts.First(i) == moved) poses[i] = T_new_old * poses[i];
  }
  parts.Join(loop.from, loop.to);
}

}  // namespace

void JoinSegments(const JoinRule& rule, const OdometryChains& chains,
                  const std::vector<Measurement>& loops, DisjointSets& parts,
                  std::vector<Pose>& poses) {
  while (true) {
    const Hypothesis best = BestJoin(rule, chains, loops, parts);
    if (best.support < rule.least_loops || best.support == 0) return;
    Join(best.loop, parts, poses);
  }
}

}  // namespace hv::loop
