#include <cstdio>
#include <string>

#include <tbb/global_control.h>
#include <CLI/CLI.hpp>

#include "hv_core/error.h"
#include "hv_core/memory.h"
#include "hv_replay/exploration_drive.h"
#include "hv_sim/world.h"
#include "simulation_arguments.h"
#include "tool.h"

namespace {

struct Arguments : SimulationArguments {
  hv::replay::ExplorationDriveOptions options;
  std::string planner;
  std::string weights;
  bool json = false;
};

void Declare(CLI::App& app, Arguments& arguments) {
  hv::replay::ExplorationDriveOptions& options = arguments.options;
  DeclareSimulation(app, arguments);
  app.add_option("--planner", arguments.planner,
                 "nearest, utility, ratio, tour, branch or sac; else as configured");
  app.add_option("--weights", arguments.weights, "of the planner `sac`; else as configured");
  app.add_option("--time-limit", options.time_limit_s, "simulated time after which it ends [s]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--return-home", options.return_home, "drive to where it began, in the end");
  app.add_flag("--truth-pose", options.truth_pose,
               "the robot is told where it is, instead of odometry");
  app.add_option("--out", options.out, "folder for the results, created when missing")->required();
  app.add_flag("--json", arguments.json, "print the summary as one JSON object");
}

hv::replay::SlamConfig ConfigOf(const Arguments& arguments) {
  hv::replay::SlamConfig config = ReadSlamConfig(arguments);
  hv::explore::ChoiceConfig& choice = config.exploration.explorer.choice;
  if (!arguments.planner.empty()) choice.planner = arguments.planner;
  if (!arguments.weights.empty()) choice.weights = arguments.weights;
  hv::ConfigProblems problems;
  config.exploration.Validate(problems);
  if (!problems.lines().empty()) throw hv::InputError("--planner: " + problems.lines().front());
  return config;
}

void Print(const hv::replay::ExplorationDriveResult& result, const std::string& out) {
  const hv::replay::CoveragePoint& last = result.coverage.back();
  std::printf("ended                %s\n", result.exploration.reason.c_str());
  std::printf("known                %.1f %% of %.0f m^2\n", 100.0 * last.share,
              result.reachable_m2);
  std::printf("driven               %.1f m in %.0f s\n", last.travelled_m, last.time_s);
  if (const hv::replay::CoveragePoint* most = result.WhenKnown(0.9)) {
    std::printf("90 %% known after     %.1f m in %.0f s\n", most->travelled_m, most->time_s);
  }
  std::printf("goals                %d, %d failed\n", result.exploration.progress.goals,
              result.exploration.progress.failed_goals);
  std::printf("collisions           %d\n", result.collisions.collisions);
  std::printf("results in           %s\n", out.c_str());
}

int Run(const Arguments& arguments) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  LargestParallelism(arguments));
  const hv::sim::LiveConfig& simulation = arguments.simulation;
  hv::replay::ExplorationDrive drive(
      ConfigOf(arguments), hv::sim::MakeWorld(simulation.world, simulation.clutter_seed()),
      simulation, arguments.options);
  const hv::replay::ExplorationDriveResult result = drive.Run();
  if (arguments.json) {
    std::printf("%s\n", hv::replay::SummaryJson(result).ToString().c_str());
  } else {
    Print(result, arguments.options.out);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  hv::KeepFreedMemory();
  CLI::App app("Explores a simulated world with a robot, without a ROS master.", "hv_explore");
  Arguments arguments;
  Declare(app, arguments);
  return hv::replay::RunTool(app, argc, argv, [&arguments] { return Run(arguments); });
}
