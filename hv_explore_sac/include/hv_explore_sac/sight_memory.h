#pragma once

#include <unordered_map>
#include <vector>

#include "hv_explore_sac/ray_sensor.h"

namespace hv::explore {

/// What is seen from the cells of one map, remembered so that sensing there again costs a tenth:
/// for runs that come to the same places many times. Not thread-safe; map and sensor must outlive
/// it.
class SightMemory {
 public:
  SightMemory(const RaySensor& sensor, const ExplorationMap& map) : sensor_(sensor), map_(map) {}

  /// The same as the sensor's.
  void Sense(const Eigen::Vector2i& from, Belief& belief);

 private:
  struct Sight {
    int cell;
    bool is_free;
  };
  std::vector<Sight> Look(const Eigen::Vector2i& from) const;

  const RaySensor& sensor_;
  const ExplorationMap& map_;
  std::unordered_map<int, std::vector<Sight>> seen_from_;  ///< by cell, in the sensor's order
};

}  // namespace hv::explore
