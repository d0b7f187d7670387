#include "hv_explore_sac/viewpoint_graph.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hv::explore {
namespace {

/// The multiples of a spacing in [low, end), rounded.
std::vector<int> Samples(int low, int end, double spacing) {
  std::vector<int> samples;
  for (int i = static_cast<int>(std::floor(low / spacing));; ++i) {
    const int at = static_cast<int>(std::lround(i * spacing));
    if (at >= end) return samples;
    if (at >= low) samples.push_back(at);
  }
}

/// Of each cell, whether it belongs to the lattice.
std::vector<char> Lattice(const ViewpointConfig& config, const Belief& belief) {
  const Eigen::Vector2i& low = belief.low();
  const Eigen::Vector2i end = low + Eigen::Vector2i(belief.width(), belief.height());
  std::vector<char> lattice(static_cast<std::size_t>(belief.width() * belief.height()), 0);
  for (const int y : Samples(low.y(), end.y(), config.spacing_y)) {
    for (const int x : Samples(low.x(), end.x(), config.spacing_x)) {
      lattice[static_cast<std::size_t>(belief.IndexOf({x, y}))] = 1;
    }
  }
  return lattice;
}

}  // namespace

ViewpointGraph::ViewpointGraph(const ViewpointConfig& config, const Belief& belief)
    : config_(config),
      low_(belief.low()),
      width_(belief.width()),
      on_lattice_(std::make_shared<const std::vector<char>>(Lattice(config, belief))) {
  Rebuild(belief);
}

void ViewpointGraph::Update(const Belief& belief) {
  if (belief.lost_free()) {
    Rebuild(belief);
    ++renumberings_;
    return;
  }
  RecheckEdges(belief);
  for (const Belief::CellChange& change : belief.changes()) {
    if (!OnLattice(change.index) || belief.At(change.index) != Cell::kFree) continue;
    Add(belief.CellOf(change.index), belief);
  }
  for (int viewpoint = 0; viewpoint < size(); ++viewpoint) ListEdges(viewpoint);
}

int ViewpointGraph::Add(const Eigen::Vector2i& cell, const Belief& belief) {
  const int known = At(cell);
  if (known >= 0) return known;
  const int viewpoint = Insert(cell, belief);
  for (int other = 0; other < size(); ++other) ListEdges(other);
  return viewpoint;
}

int ViewpointGraph::At(const Eigen::Vector2i& cell) const {
  const auto found = viewpoint_at_.find((cell.y() - low_.y()) * width_ + cell.x() - low_.x());
  return found == viewpoint_at_.end() ? -1 : found->second;
}

void ViewpointGraph::Rebuild(const Belief& belief) {
  const std::vector<Eigen::Vector2i> old_cells = std::move(cells_);
  const std::vector<char> old_visited = std::move(visited_);
  viewpoint_at_.clear();
  cells_.clear();
  visited_.clear();
  nearest_.clear();
  edges_.clear();
  stale_.clear();
  // Places that were added stay, and so does what was visited.
  for (std::size_t i = 0; i < old_cells.size(); ++i) {
    if (belief.At(old_cells[i]) != Cell::kFree) continue;
    const int viewpoint = Insert(old_cells[i], belief);
    visited_[Index(viewpoint)] = old_visited[i];
  }
  for (int cell = 0; cell < static_cast<int>(on_lattice_->size()); ++cell) {
    if (!OnLattice(cell) || belief.At(cell) != Cell::kFree) continue;
    if (At(belief.CellOf(cell)) < 0) Insert(belief.CellOf(cell), belief);
  }
  for (int viewpoint = 0; viewpoint < size(); ++viewpoint) ListEdges(viewpoint);
}

int ViewpointGraph::Insert(const Eigen::Vector2i& cell, const Belief& belief) {
  const int viewpoint = size();
  const int place = belief.IndexOf(cell);
  viewpoint_at_[place] = viewpoint;
  cells_.push_back(cell);
  visited_.push_back(0);
  nearest_.emplace_back().reserve(Index(config_.neighbors + 1));
  edges_.emplace_back();
  stale_.push_back(1);
  for (int other = 0; other < viewpoint; ++other) {
    const int distance2 = (cells_[Index(other)] - cell).squaredNorm();
    Offer(viewpoint, {distance2, belief.IndexOf(cells_[Index(other)]), other, 0}, belief);
    Offer(other, {distance2, place, viewpoint, 0}, belief);
  }
  return viewpoint;
}

void ViewpointGraph::Offer(int viewpoint, Neighbor neighbor, const Belief& belief) {
  std::vector<Neighbor>& nearest = nearest_[Index(viewpoint)];
  const auto nearer = [](const Neighbor& a, const Neighbor& b) {
    return std::pair(a.distance2, a.place) < std::pair(b.distance2, b.place);
  };
  const bool full = nearest.size() >= Index(config_.neighbors);
  if (full && !nearer(neighbor, nearest.back())) return;
  const auto [from, to] = LineBetween(viewpoint, neighbor.viewpoint, belief);
  neighbor.blocked = belief.FirstBlocked(from, to);
  if (full) nearest.pop_back();
  nearest.insert(std::upper_bound(nearest.begin(), nearest.end(), neighbor, nearer), neighbor);
  stale_[Index(viewpoint)] = 1;
}

void ViewpointGraph::RecheckEdges(const Belief& belief) {
  for (int viewpoint = 0; viewpoint < size(); ++viewpoint) {
    for (Neighbor& neighbor : nearest_[Index(viewpoint)]) {
      if (neighbor.blocked == Belief::kNone || belief.At(neighbor.blocked) != Cell::kFree) continue;
      const auto [from, to] = LineBetween(viewpoint, neighbor.viewpoint, belief);
      neighbor.blocked = belief.FirstBlocked(from, to, neighbor.blocked);
      if (neighbor.blocked == Belief::kNone) stale_[Index(viewpoint)] = 1;
    }
  }
}

void ViewpointGraph::ListEdges(int viewpoint) {
  if (stale_[Index(viewpoint)] == 0) return;
  stale_[Index(viewpoint)] = 0;
  std::vector<Edge>& edges = edges_[Index(viewpoint)];
  edges.clear();
  for (const Neighbor& neighbor : nearest_[Index(viewpoint)]) {
    if (neighbor.blocked != Belief::kNone) continue;
    edges.push_back({neighbor.viewpoint, std::sqrt(static_cast<float>(neighbor.distance2))});
  }
}

/// Always in the same direction: the line back passes other cells.
std::pair<Eigen::Vector2i, Eigen::Vector2i> ViewpointGraph::LineBetween(
    int first, int second, const Belief& belief) const {
  const Eigen::Vector2i& a = cells_[Index(first)];
  const Eigen::Vector2i& b = cells_[Index(second)];
  return belief.IndexOf(a) < belief.IndexOf(b) ? std::pair(a, b) : std::pair(b, a);
}

}  // namespace hv::explore
