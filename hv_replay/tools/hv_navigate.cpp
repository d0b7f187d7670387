#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <tbb/global_control.h>
#include <CLI/CLI.hpp>

#include "hv_core/memory.h"
#include "hv_replay/navigation_run.h"
#include "hv_sim/world.h"
#include "simulation_arguments.h"
#include "tool.h"

namespace {

struct Arguments : SimulationArguments {
  hv::replay::NavigationRunOptions options;
  std::string scenario = "random";
  bool json = false;
};

void Declare(CLI::App& app, Arguments& arguments) {
  hv::replay::NavigationRunOptions& options = arguments.options;
  DeclareSimulation(app, arguments);
  app.add_option("--map", options.map,
                 "map folder with a grid; without one, odometry alone is driven by");
  app.add_option("--map-truth", options.map_truth,
                 "TUM file, true poses of the run that made the map, to judge by");
  app.add_option("--goals", options.goals, "how many are driven to")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--least-distance", options.least_m, "from one goal to the next [m]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--scenario", arguments.scenario,
                 "random, low_obstacles or blocked_corridor: what gets in the way")
      ->capture_default_str();
  app.add_flag("--truth-pose", options.truth_pose,
               "the robot is told where it is, instead of odometry and localisation");
  app.add_option("--out", options.out, "folder for the results, created when missing")->required();
  app.add_flag("--json", arguments.json, "print the summary as one JSON object");
}

void Print(const std::vector<hv::replay::NavigationTrial>& trials, const std::string& out) {
  int collisions = 0;
  int reached = 0;
  for (const hv::replay::NavigationTrial& trial : trials) {
    collisions += trial.collisions;
    reached += trial.reached ? 1 : 0;
    if (!trial.reached) std::printf("goal %d: %s\n", trial.number, trial.reason.c_str());
  }
  std::printf("reached              %d of %zu goals\n", reached, trials.size());
  std::printf("collisions           %d\n", collisions);
  std::printf("results in           %s\n", out.c_str());
}

int Run(Arguments& arguments) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  LargestParallelism(arguments));
  arguments.options.scenario = hv::replay::ParseScenario(arguments.scenario);
  hv::replay::NavigationRun run(
      ReadSlamConfig(arguments),
      hv::sim::MakeWorld(arguments.simulation.world, arguments.simulation.clutter_seed()),
      arguments.simulation, arguments.options);
  const std::vector<hv::replay::NavigationTrial> trials = run.Run();
  if (arguments.json) {
    std::printf("%s\n", hv::replay::SummaryJson(trials).ToString().c_str());
  } else {
    Print(trials, arguments.options.out);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  hv::KeepFreedMemory();
  CLI::App app("Drives a simulated robot to random goals, without a ROS master.", "hv_navigate");
  Arguments arguments;
  Declare(app, arguments);
  return hv::replay::RunTool(app, argc, argv, [&arguments] { return Run(arguments); });
}
