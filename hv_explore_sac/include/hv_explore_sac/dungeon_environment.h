#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hv_explore_sac/exploration_map.h"
#include "hv_explore_sac/exploration_model.h"
#include "hv_explore_sac/ray_sensor.h"
#include "hv_explore_sac/reward.h"
#include "hv_explore_sac/sight_memory.h"

namespace hv::explore {

/// Why an exploration ended.
enum class Ending {
  kRunning,
  kExplored,     ///< the free space of the map is known
  kNoFrontiers,  ///< no viewpoint that can be reached observes frontiers
  kGivenUp       ///< too many decisions
};
std::string ToString(Ending ending);

/// The public dungeon benchmark in two dimensions: the robot drives in straight lines from
/// viewpoint to viewpoint and senses where it decides, nowhere else. Copies go on by themselves,
/// but share the `memory` of the map, if there is one. Not thread-safe; the map and the sensor must
/// outlive it.
class DungeonEnvironment {
 public:
  DungeonEnvironment(const ExplorationConfig& config, const RewardConfig& reward,
                     const RaySensor& sensor, const ExplorationMap& map,
                     std::shared_ptr<SightMemory> memory = nullptr);

  /// Drives to a viewpoint that is joined to the robot's by an edge, and senses there. Throws
  /// std::invalid_argument when there is no such edge.
  Reward Step(int viewpoint);

  /// From the standpoint of a planner.
  void Observe(Observation& observation) const { model_.Observe(observation); }

  const ExplorationMap& map() const { return map_; }
  const ExplorationModel& model() const { return model_; }
  Ending ending() const { return ending_; }
  /// Whether the run has ended as it should.
  bool complete() const { return ending_ == Ending::kExplored || ending_ == Ending::kNoFrontiers; }
  int steps() const { return static_cast<int>(path_.size()) - 1; }
  double travel() const { return travel_; }                                  ///< [cells]
  int unseen() const { return free_count_ - model_.belief().free_count(); }  ///< free cells
  double explored() const;                                                   ///< share, 0 to 1
  const std::vector<Eigen::Vector2i>& path() const { return path_; }  ///< cells, the start first

 private:
  void SenseAt(const Eigen::Vector2i& cell);
  Ending Judge() const;
  double LengthTo(int viewpoint) const;

  ExplorationConfig config_;
  RewardConfig reward_;
  const RaySensor& sensor_;
  const ExplorationMap& map_;
  std::shared_ptr<SightMemory> memory_;
  int free_count_;
  ExplorationModel model_;
  std::vector<Eigen::Vector2i> path_;
  double travel_ = 0.0;
  Ending ending_ = Ending::kRunning;
};

}  // namespace hv::explore
