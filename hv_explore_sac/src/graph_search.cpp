#include "hv_explore_sac/graph_search.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <utility>

namespace hv::explore {
namespace {

/// Compares like the pair: floats that are not negative have the order of their bits.
std::uint64_t Key(float distance, int viewpoint) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &distance, sizeof(bits));
  return std::uint64_t{bits} << 32U | static_cast<std::uint32_t>(viewpoint);
}

std::pair<float, int> FromKey(std::uint64_t key) {
  const auto bits = static_cast<std::uint32_t>(key >> 32U);
  float distance = 0.0F;
  std::memcpy(&distance, &bits, sizeof(distance));
  return {distance, static_cast<int>(key & 0xffffffffU)};
}

}  // namespace

void GraphSearch::Run(const ViewpointGraph& graph, int start) {
  Run(graph, start, [](int) { return false; });
}

void GraphSearch::RunTo(const ViewpointGraph& graph, int start, const std::vector<int>& targets) {
  auto left = static_cast<std::ptrdiff_t>(targets.size());
  Run(graph, start, [&](int viewpoint) {
    left -= std::count(targets.begin(), targets.end(), viewpoint);
    return left == 0;
  });
}

template <typename Last>
void GraphSearch::Run(const ViewpointGraph& graph, int start, Last is_last) {
  const auto size = static_cast<std::size_t>(graph.size());
  distance_.assign(size, kUnreached);
  predecessor_.assign(size, -1);
  order_.clear();
  open_.assign(1, Key(0.0F, start));
  distance_[static_cast<std::size_t>(start)] = 0.0F;
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    const auto [distance, viewpoint] = FromKey(open_.back());
    open_.pop_back();
    if (distance > DistanceTo(viewpoint)) continue;
    order_.push_back(viewpoint);
    if (is_last(viewpoint)) return;
    for (const ViewpointGraph::Edge& edge : graph.EdgesOf(viewpoint)) {
      const auto to = static_cast<std::size_t>(edge.to);
      if (distance + edge.length >= distance_[to]) continue;
      distance_[to] = distance + edge.length;
      predecessor_[to] = viewpoint;
      open_.push_back(Key(distance_[to], edge.to));
      std::push_heap(open_.begin(), open_.end(), std::greater<>());
    }
  }
}

std::vector<int> GraphSearch::WayTo(int viewpoint) const {
  std::vector<int> way;
  for (int at = viewpoint; at >= 0; at = Predecessor(at)) way.push_back(at);
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace hv::explore
