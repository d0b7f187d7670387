#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hv_explore_sac/exploration_map.h"

namespace hv::explore {

/// A new map out of two: of `maps`, what lies left of a column (or above a row) comes from one, the
/// rest from another one of the same size, each perhaps mirrored. Kept is what is connected with
/// the start; nearly all is. Cuts lie between the tiles that dungeon maps are made of. Depends on
/// the seed alone. Throws InputError when no two maps go together.
ExplorationMap CrossedMap(const std::vector<const ExplorationMap*>& maps, std::uint64_t seed);

/// The `count` maps whose turn it is when they are taken one after the other, over and over, and
/// `taken` were taken before.
std::vector<const ExplorationMap*> InTurn(const std::vector<const ExplorationMap*>& maps,
                                          std::size_t taken, std::size_t count);

/// Maps to learn from: those given, then crossed ones, which are made when they are asked for, so
/// that many take no memory. Thread-safe.
class MapSupply {
 public:
  /// The maps must outlive it.
  explicit MapSupply(std::vector<const ExplorationMap*> given) : given_(std::move(given)) {}

  /// Adds `count` maps crossed out of `parents`, which must outlive it.
  void AddCrossed(std::vector<const ExplorationMap*> parents, std::size_t count,
                  std::uint64_t seed);

  std::size_t size() const { return given_.size() + crossed_; }
  ExplorationMap Map(std::size_t index) const;

 private:
  std::vector<const ExplorationMap*> given_;
  std::vector<const ExplorationMap*> parents_;
  std::size_t crossed_ = 0;
  std::uint64_t seed_ = 0;
};

}  // namespace hv::explore
