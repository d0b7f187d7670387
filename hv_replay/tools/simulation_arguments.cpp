#include "simulation_arguments.h"

#include <tbb/global_control.h>
#include <yaml-cpp/yaml.h>

#include "hv_core/config.h"
#include "hv_sim/world.h"

namespace {

std::string Worlds() {
  std::string names;
  for (const std::string& name : hv::sim::WorldNames()) {
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

}  // namespace

void DeclareSimulation(CLI::App& app, SimulationArguments& arguments) {
  hv::sim::LiveConfig& simulation = arguments.simulation;
  app.add_option("--world", simulation.world,
                 "one of " + Worlds() + "; or the YAML of a floor plan")
      ->capture_default_str();
  app.add_option("--world-seed", simulation.world_seed, "of clutter alone; below 0: as --seed")
      ->capture_default_str();
  app.add_option("--seed", simulation.seed, "of start, goals and every noise")
      ->capture_default_str();
  app.add_option("--point-share", simulation.point_share,
                 "share of LiDAR columns fired, in (0, 1], for speed")
      ->check(CLI::Range(0.01, 1.0))
      ->capture_default_str();
  app.add_flag("!--no-people", simulation.people, "nobody walks around");
  app.add_option("--config", arguments.config, "configuration (YAML), e.g. config/robot.yaml")
      ->required();
  app.add_option("--threads", arguments.threads, "threads of all work; 0: as configured")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

hv::replay::SlamConfig ReadSlamConfig(const SimulationArguments& arguments) {
  hv::replay::SlamConfig config;
  hv::ReadConfig(hv::LoadYamlFile(arguments.config), arguments.config, config);
  if (arguments.threads > 0) config.system.odometry.threads = arguments.threads;
  return config;
}

std::size_t LargestParallelism(const SimulationArguments& arguments) {
  if (arguments.threads > 0) return static_cast<std::size_t>(arguments.threads);
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}
