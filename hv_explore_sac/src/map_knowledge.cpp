#include "map_knowledge.h"

#include "hv_explore_sac/graph_search.h"

namespace hv::explore {
namespace {

int CountBits(std::uint64_t word) { return __builtin_popcountll(word); }

void Insert(CellSet& cells, int number) {
  cells[static_cast<std::size_t>(number) / 64] |= std::uint64_t{1} << (number % 64);
}

Belief TruthOf(const ExplorationMap& map) {
  Belief truth(map.width, map.height);
  for (int cell = 0; cell < map.width * map.height; ++cell) {
    truth.Set(cell, map.IsFree(cell) ? Cell::kFree : Cell::kOccupied);
  }
  truth.ClearChanges();
  return truth;
}

}  // namespace

int CountCells(const CellSet& cells) {
  int count = 0;
  for (const std::uint64_t word : cells) count += CountBits(word);
  return count;
}

int CountMissing(const CellSet& cells, const CellSet& added) {
  int count = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) count += CountBits(added[i] & ~cells[i]);
  return count;
}

MapKnowledge::MapKnowledge(const ExplorationConfig& config, const RaySensor& sensor,
                           const ExplorationMap& map)
    : truth_(TruthOf(map)), graph_(config.viewpoint, truth_) {
  graph_.Add(map.start, truth_);
  NumberCells(map);
  FindWays();
  FindViews(sensor, map);
}

CellSet MapKnowledge::KnownIn(const Belief& belief) const {
  CellSet known = EmptySet();
  for (int cell = 0; cell < static_cast<int>(number_.size()); ++cell) {
    const int number = number_[static_cast<std::size_t>(cell)];
    if (number >= 0 && belief.At(cell) == Cell::kFree) Insert(known, number);
  }
  return known;
}

void MapKnowledge::NumberCells(const ExplorationMap& map) {
  int free = 0;
  for (int cell = 0; cell < map.width * map.height; ++cell) {
    const bool counted = map.IsFree(cell) && free++ % kStride == 0;
    number_.push_back(counted ? total_++ : -1);
  }
}

void MapKnowledge::FindWays() {
  const auto pairs = static_cast<std::size_t>(size()) * static_cast<std::size_t>(size());
  distance_.assign(pairs, GraphSearch::kUnreached);
  next_hop_.assign(pairs, -1);
  GraphSearch search;
  for (int from = 0; from < size(); ++from) {
    search.Run(graph_, from);
    for (const int to : search.order()) {
      const int before = search.Predecessor(to);
      distance_[Index(from, to)] = search.DistanceTo(to);
      next_hop_[Index(from, to)] = before < 0 || before == from ? to : NextHop(from, before);
    }
  }
}

void MapKnowledge::FindViews(const RaySensor& sensor, const ExplorationMap& map) {
  for (int viewpoint = 0; viewpoint < size(); ++viewpoint) {
    CellSet& seen = seen_.emplace_back(EmptySet());
    sensor.Cast(map, graph_.CellOf(viewpoint), [&](int cell, bool is_free) {
      const int number = number_[static_cast<std::size_t>(cell)];
      if (is_free && number >= 0) Insert(seen, number);
    });
  }
}

}  // namespace hv::explore
