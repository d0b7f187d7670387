#include "hv_explore_sac/train/map_supply.h"

#include <random>
#include <utility>

#include "hv_core/error.h"
#include "uniform.h"

namespace hv::explore {
namespace {

constexpr double kLeastShare = 0.3;      ///< of the width or height, on either side of the cut
constexpr double kLeastConnected = 0.9;  ///< of the free cells
constexpr int kTries = 1000;

/// A map as it lies, or mirrored.
class MirroredMap {
 public:
  MirroredMap(const ExplorationMap& map, bool across, bool upside_down)
      : map_(map), across_(across), upside_down_(upside_down) {}

  char At(int x, int y) const {
    const int column = across_ ? map_.width - 1 - x : x;
    const int row = upside_down_ ? map_.height - 1 - y : y;
    return map_.free[static_cast<std::size_t>(map_.IndexOf({column, row}))];
  }

 private:
  const ExplorationMap& map_;
  bool across_;
  bool upside_down_;
};

/// Leaves free what can be reached from `start` alone; returns how many cells that are.
int KeepConnected(int start, ExplorationMap& map) {
  std::vector<char> kept(map.free.size(), 0);
  std::vector<int> open{start};
  kept[static_cast<std::size_t>(start)] = 1;
  int count = 0;
  while (!open.empty()) {
    const int index = open.back();
    open.pop_back();
    ++count;
    const Eigen::Vector2i cell(index % map.width, index / map.width);
    for (const Eigen::Vector2i& step : {Eigen::Vector2i(1, 0), Eigen::Vector2i(-1, 0),
                                        Eigen::Vector2i(0, 1), Eigen::Vector2i(0, -1)}) {
      const Eigen::Vector2i next = cell + step;
      if (!map.Contains(next) || !map.IsFree(map.IndexOf(next))) continue;
      char& seen = kept[static_cast<std::size_t>(map.IndexOf(next))];
      if (seen == 0) open.push_back(map.IndexOf(next));
      seen = 1;
    }
  }
  map.free = std::move(kept);
  return count;
}

/// Crosses two maps of a kind at random.
class Crossing {
 public:
  Crossing(const std::vector<const ExplorationMap*>& maps, std::uint64_t seed)
      : maps_(maps), random_(seed) {}

  ExplorationMap Run() {
    for (int i = 0; i < kTries && maps_.size() > 1; ++i) {
      const ExplorationMap& first = *maps_[random_() % maps_.size()];
      const ExplorationMap& second = *maps_[random_() % maps_.size()];
      if (&first == &second || first.width != second.width || first.height != second.height) {
        continue;
      }
      ExplorationMap map = Join(first, second);
      if (Start(map)) return map;
    }
    throw InputError("no two of " + std::to_string(maps_.size()) + " maps can be crossed");
  }

 private:
  ExplorationMap Join(const ExplorationMap& first, const ExplorationMap& second) {
    ExplorationMap map = first;
    map.name = first.name + " x " + second.name;
    const MirroredMap one(first, Toss(), Toss());
    const MirroredMap other(second, Toss(), Toss());
    const bool columns = Toss();
    const int cut = Cut(columns ? map.width : map.height);
    for (int y = 0; y < map.height; ++y) {
      for (int x = 0; x < map.width; ++x) {
        const MirroredMap& source = (columns ? x : y) < cut ? one : other;
        map.free[static_cast<std::size_t>(map.IndexOf({x, y}))] = source.At(x, y);
      }
    }
    return map;
  }

  bool Toss() { return Uniform(random_) < 0.5; }

  int Cut(int length) {
    const double share = kLeastShare + (1.0 - 2.0 * kLeastShare) * Uniform(random_);
    return kTileCells * static_cast<int>(share * length / kTileCells);
  }

  /// Starts anywhere; false when too much of the map cannot be reached from there.
  bool Start(ExplorationMap& map) {
    const int free = map.CountFree();
    if (free == 0) return false;
    std::size_t index = 0;
    do {
      index = random_() % map.free.size();
    } while (map.free[index] == 0);
    const int start = static_cast<int>(index);
    map.start = {start % map.width, start / map.width};
    return KeepConnected(start, map) >= kLeastConnected * free;
  }

  const std::vector<const ExplorationMap*>& maps_;
  std::mt19937_64 random_;
};

}  // namespace

ExplorationMap CrossedMap(const std::vector<const ExplorationMap*>& maps, std::uint64_t seed) {
  return Crossing(maps, seed).Run();
}

std::vector<const ExplorationMap*> InTurn(const std::vector<const ExplorationMap*>& maps,
                                          std::size_t taken, std::size_t count) {
  std::vector<const ExplorationMap*> chosen(count);
  for (std::size_t i = 0; i < count; ++i) chosen[i] = maps[(taken + i) % maps.size()];
  return chosen;
}

void MapSupply::AddCrossed(std::vector<const ExplorationMap*> parents, std::size_t count,
                           std::uint64_t seed) {
  parents_ = std::move(parents);
  crossed_ = count;
  seed_ = seed;
}

ExplorationMap MapSupply::Map(std::size_t index) const {
  if (index < given_.size()) return *given_[index];
  return CrossedMap(parents_, seed_ + index - given_.size());
}

}  // namespace hv::explore
