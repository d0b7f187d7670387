#include <cstdio>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>
#include <CLI/CLI.hpp>

#include "guess.h"
#include "hv_core/config.h"
#include "hv_core/error.h"
#include "hv_core/memory.h"
#include "hv_replay/localize_run.h"
#include "tool.h"

namespace {

struct Arguments {
  std::string map;
  std::string config;
  std::vector<std::string> bags;
  std::string out;
  std::vector<double> guess;
  int threads = 0;
  bool no_pictures = false;
  bool json = false;
};

void Declare(CLI::App& app, Arguments& arguments) {
  app.add_option("--map", arguments.map, "map folder, PCD or PLY")->required();
  app.add_option("--config", arguments.config, "configuration (YAML), e.g. config/hilti_2022.yaml")
      ->required();
  app.add_option("--bag", arguments.bags, "bags, read as one")->required();
  app.add_option("--out", arguments.out, "folder for the results, created when missing")
      ->required();
  hv::replay::DeclareGuess(app, arguments.guess, "about where the IMU is in the map at the start");
  app.add_option("--threads", arguments.threads, "threads of one scan's work; 0: as configured")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_flag("--no-pictures", arguments.no_pictures, "skip map.png");
  app.add_flag("--json", arguments.json, "print the summary as one JSON object");
}

void Print(const hv::replay::LocalizeRunSummary& summary, const std::string& out) {
  std::printf("scans                %zu, %zu localised\n", summary.scans, summary.localized);
  if (summary.first_pose_s >= 0.0) {
    std::printf("first place after    %.1f s\n", summary.first_pose_s);
  }
  std::printf("lost                 %zu times, at most %.1f s\n", summary.losses,
              summary.longest_search_s);
  std::printf("results in           %s\n", out.c_str());
}

int Run(const Arguments& arguments) {
  hv::replay::SlamConfig config;
  hv::ReadConfig(hv::LoadYamlFile(arguments.config), arguments.config, config);
  if (arguments.threads > 0) config.system.odometry.threads = arguments.threads;
  hv::replay::LocalizeRun run(
      config, {arguments.map, arguments.bags, arguments.out, hv::replay::GuessFrom(arguments.guess),
               !arguments.no_pictures});
  const hv::replay::LocalizeRunSummary summary = run.Run();
  if (arguments.json) {
    std::printf("%s\n", hv::replay::SummaryJson(summary).ToString().c_str());
  } else {
    Print(summary, arguments.out);
  }
  if (!summary.odometry.error.empty()) throw hv::InputError(summary.odometry.error);
  if (summary.localized == 0) throw hv::InputError("no scan could be localised");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  hv::KeepFreedMemory();
  CLI::App app("Localises a recording in a saved map, without a ROS master.", "hv_localize");
  Arguments arguments;
  Declare(app, arguments);
  return hv::replay::RunTool(app, argc, argv, [&arguments] { return Run(arguments); });
}
