#include "skeleton.h"

namespace hv::loop {
namespace {

std::vector<bool> Touched(const OdometryChains& chains, const std::vector<Measurement>& loops) {
  std::vector<bool> touched(chains.size(), false);
  for (const Measurement& loop : loops) {
    touched[loop.from] = true;
    touched[loop.to] = true;
  }
  return touched;
}

/// Share of `i` on the way from `a` to `b`.
double Share(std::size_t a, std::size_t i, std::size_t b) {
  return static_cast<double>(i - a) / static_cast<double>(b - a);
}

}  // namespace

Skeleton::Skeleton(const OdometryChains& chains, const std::vector<Measurement>& loops)
    : positions_(chains.size()), before_(chains.size()), after_(chains.size()) {
  FindNeighbours(chains, Touched(chains, loops));
  Connect(chains, loops);
}

void Skeleton::FindNeighbours(const OdometryChains& chains, const std::vector<bool>& keep) {
  std::vector<std::size_t> last(chains.size());  // kept vertex seen last, by first of its chain
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const std::size_t first = chains.First(i);
    after_[i] = i;
    if (keep[i] || first == i) {
      positions_[i] = vertices_.size();
      vertices_.push_back(i);
      if (first != i) after_[last[first]] = i;
      last[first] = i;
    }
    before_[i] = last[first];
  }
  for (std::size_t i = 0; i < chains.size(); ++i) after_[i] = after_[before_[i]];
}

void Skeleton::Connect(const OdometryChains& chains, const std::vector<Measurement>& loops) {
  for (const std::size_t vertex : vertices_) {
    const std::size_t next = after_[vertex];
    if (next == vertex) continue;
    const UncertainPose step = chains.Between(vertex, next);
    odometry_.push_back(
        {positions_[vertex], positions_[next], step.T_a_b, InverseOf(step.covariance)});
  }
  for (const Measurement& loop : loops) {
    loops_.push_back(
        {positions_[loop.from], positions_[loop.to], loop.T_from_to, loop.information});
  }
}

void Skeleton::Spread(const std::vector<Pose>& kept, std::vector<Pose>& poses) const {
  const std::vector<Pose> old = poses;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::size_t a = before_[i];
    const std::size_t b = after_[i];
    poses[i] = kept[positions_[a]] * (old[a].inverse() * old[i]);
    if (a == b || a == i) continue;
    const Pose T_b_a = old[b].inverse() * old[a];
    const Vector6d moved = se3::Log(T_b_a * kept[positions_[a]].inverse() * kept[positions_[b]]);
    const Matrix6d transport = se3::Adjoint(old[i].inverse() * old[b]);
    poses[i] = poses[i] * se3::Exp(transport * (Share(a, i, b) * moved));
  }
}

}  // namespace hv::loop
