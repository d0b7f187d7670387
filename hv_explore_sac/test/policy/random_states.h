#pragma once

#include <memory>
#include <random>

#include "hv_explore_sac/dungeon_environment.h"
#include "random_maps.h"

namespace hv::explore {

/// An exploration of a random map, some random edges old.
struct RandomState {
  explicit RandomState(unsigned seed, int steps = 6)
      : sensor(config.simulation),
        map(RandomMap(seed)),
        environment(config, RewardConfig(), sensor, map) {
    std::mt19937 random(seed);
    for (int i = 0; i < steps && environment.ending() == Ending::kRunning; ++i) {
      environment.Observe(observation);
      const Observation::EdgeRange actions = observation.Actions();
      environment.Step(observation.node(actions[random() % actions.size()].to).viewpoint);
    }
    environment.Observe(observation);
  }
  bool running() const { return environment.ending() == Ending::kRunning; }

  ExplorationConfig config;
  RaySensor sensor;
  ExplorationMap map;
  DungeonEnvironment environment;
  Observation observation;
};

}  // namespace hv::explore
