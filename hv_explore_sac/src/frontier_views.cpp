#include "hv_explore_sac/frontier_views.h"

#include <algorithm>

namespace hv::explore {

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
    const std::vector<View>& views = views_[static_cast<std::size_t>(viewpoint)];
    seen_[static_cast<std::size_t>(viewpoint)] =
        static_cast<int>(std::count_if(views.begin(), views.end(), [](const View& view) {
          return view.blocked == Belief::kNone;
        }));
  }
}

void FrontierViews::ListSeen(int viewpoint, std::vector<int>& points) const {
  points.clear();
  for (const View& view : views_[static_cast<std::size_t>(viewpoint)]) {
    if (view.blocked == Belief::kNone) points.push_back(view.point);
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

}  // namespace hv::explore
