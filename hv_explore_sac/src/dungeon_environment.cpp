#include "hv_explore_sac/dungeon_environment.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace hv::explore {

std::string ToString(Ending ending) {
  switch (ending) {
    case Ending::kRunning:
      return "still running";
    case Ending::kExplored:
      return "all free space is known";
    case Ending::kNoFrontiers:
      return "no frontiers are left that can be reached";
    case Ending::kGivenUp:
      return "given up after too many decisions";
  }
  return "";
}

DungeonEnvironment::DungeonEnvironment(const ExplorationConfig& config, const RewardConfig& reward,
                                       const RaySensor& sensor, const ExplorationMap& map,
                                       std::shared_ptr<SightMemory> memory)
    : config_(config),
      reward_(reward),
      sensor_(sensor),
      map_(map),
      memory_(std::move(memory)),
      free_count_(map.CountFree()),
      model_(config, map.width, map.height) {
  SenseAt(map.start);
}

Reward DungeonEnvironment::Step(int viewpoint) {
  const double length = LengthTo(viewpoint);
  Transition transition;
  transition.path = length;
  transition.explored_before = explored();
  transition.centroid_before = model_.frontiers().Centroid();
  const bool had_frontiers = !model_.frontiers().points().empty();
  travel_ += length;
  // A copy: the graph moves its cells when it grows.
  const Eigen::Vector2i cell = model_.graph().CellOf(viewpoint);
  SenseAt(cell);
  transition.explored_after = explored();
  transition.centroid_after = model_.frontiers().Centroid();
  transition.has_centroids = had_frontiers && !model_.frontiers().points().empty();
  transition.frontiers_observed = static_cast<int>(model_.frontiers().removed().size());
  transition.complete = complete();
  return RewardOf(transition, reward_);
}

double DungeonEnvironment::explored() const {
  return static_cast<double>(model_.belief().free_count()) / free_count_;
}

void DungeonEnvironment::SenseAt(const Eigen::Vector2i& cell) {
  if (memory_ != nullptr) {
    memory_->Sense(cell, model_.belief());
  } else {
    sensor_.Sense(map_, cell, model_.belief());
  }
  model_.Update(cell);
  path_.push_back(cell);
  ending_ = Judge();
}

Ending DungeonEnvironment::Judge() const {
  if (unseen() <= config_.simulation.unseen_allowed) return Ending::kExplored;
  const std::vector<int>& reached = model_.ways().order();
  const bool any = std::any_of(reached.begin(), reached.end(),
                               [this](int viewpoint) { return model_.UtilityOf(viewpoint) > 0; });
  if (!any) return Ending::kNoFrontiers;
  return steps() >= config_.simulation.max_steps ? Ending::kGivenUp : Ending::kRunning;
}

double DungeonEnvironment::LengthTo(int viewpoint) const {
  for (const ViewpointGraph::Edge& edge : model_.graph().EdgesOf(model_.robot())) {
    if (edge.to == viewpoint) return static_cast<double>(edge.length);
  }
  throw std::invalid_argument("no edge leads to the viewpoint");
}

}  // namespace hv::explore
