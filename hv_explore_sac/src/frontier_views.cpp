#include "hv_explore_sac/frontier_views.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "hv_core/angles.h"

namespace hv::explore {
namespace {

/// A view from nearer than this share of the distance of another one is a better one.
constexpr double kNearer = 0.7;

/// Whether a view along `other`, from a viewpoint to a point, shows what a view along `view` of the
/// same point would show.
bool Replaces(const Eigen::Vector2d& other, const Eigen::Vector2d& view, double same_side) {
  const double near = other.norm();
  const double distance = view.norm();
  return kNearer * near <= distance && other.dot(view) >= same_side * near * distance;
}

}  // namespace

void FrontierViews::Update(const Belief& belief, const Frontiers& frontiers,
                           const ViewpointGraph& graph) {
  if (graph.renumberings() != renumberings_) Restart();
  renumberings_ = graph.renumberings();
  const int known = static_cast<int>(views_.size());
  views_.resize(static_cast<std::size_t>(graph.size()));
  seen_.resize(views_.size(), 0);
  for (int viewpoint = 0; viewpoint < graph.size(); ++viewpoint) {
    const Eigen::Vector2i& cell = graph.CellOf(viewpoint);
    if (viewpoint < known) {
      Follow(viewpoint, cell, belief, frontiers);
      Look(viewpoint, cell, frontiers.added(), belief, frontiers);
    } else {
      Look(viewpoint, cell, frontiers.points(), belief, frontiers);
    }
  }
  if (config_.new_side_deg > 0.0) FindKnown(frontiers, graph);
  std::transform(views_.begin(), views_.end(), seen_.begin(), [](const std::vector<View>& views) {
    return static_cast<int>(std::count_if(views.begin(), views.end(), Observes));
  });
}

void FrontierViews::ListSeen(int viewpoint, std::vector<int>& points) const {
  points.clear();
  for (const View& view : views_[static_cast<std::size_t>(viewpoint)]) {
    if (Observes(view)) points.push_back(view.point);
  }
}

void FrontierViews::Restart() {
  views_.clear();
  seen_.clear();
}

/// Drops points that are frontiers no more and looks again where the way has cleared.
void FrontierViews::Follow(int viewpoint, const Eigen::Vector2i& cell, const Belief& belief,
                           const Frontiers& frontiers) {
  std::vector<View>& views = views_[static_cast<std::size_t>(viewpoint)];
  views.erase(std::remove_if(views.begin(), views.end(),
                             [&](const View& view) { return !frontiers.IsFrontier(view.point); }),
              views.end());
  for (View& view : views) {
    if (view.blocked == Belief::kNone || belief.At(view.blocked) != Cell::kFree) continue;
    view.blocked = belief.FirstBlocked(cell, frontiers.CellOf(view.point), view.blocked);
  }
}

void FrontierViews::Look(int viewpoint, const Eigen::Vector2i& cell, const std::vector<int>& points,
                         const Belief& belief, const Frontiers& frontiers) {
  const double range2 = config_.view_range * config_.view_range;
  for (const int point : points) {
    const Eigen::Vector2i place = frontiers.CellOf(point);
    if ((place - cell).squaredNorm() >= range2) continue;
    views_[static_cast<std::size_t>(viewpoint)].push_back(
        {point, belief.FirstBlocked(cell, place)});
  }
}

/// Compares each view with those from viewpoints where the robot has been.
void FrontierViews::FindKnown(const Frontiers& frontiers, const ViewpointGraph& graph) {
  const double same_side = std::cos(config_.new_side_deg * kRadiansPerDegree);
  const auto along = [&](int viewpoint, const View& view) -> Eigen::Vector2d {
    return (frontiers.CellOf(view.point) - graph.CellOf(viewpoint)).cast<double>();
  };
  std::unordered_map<int, std::vector<Eigen::Vector2d>> had;  // views of each point
  for (int viewpoint = 0; viewpoint < graph.size(); ++viewpoint) {
    if (!graph.Visited(viewpoint)) continue;
    for (const View& view : views_[static_cast<std::size_t>(viewpoint)]) {
      if (view.blocked == Belief::kNone) had[view.point].push_back(along(viewpoint, view));
    }
  }
  for (int viewpoint = 0; viewpoint < graph.size(); ++viewpoint) {
    for (View& view : views_[static_cast<std::size_t>(viewpoint)]) {
      if (view.blocked != Belief::kNone) continue;
      const auto others = had.find(view.point);
      view.known = others != had.end() &&
                   std::any_of(others->second.begin(), others->second.end(),
                               [&](const Eigen::Vector2d& other) {
                                 return Replaces(other, along(viewpoint, view), same_side);
                               });
    }
  }
}

}  // namespace hv::explore
