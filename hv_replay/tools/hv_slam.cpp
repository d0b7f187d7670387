#include <cstdio>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>
#include <CLI/CLI.hpp>

#include "hv_core/config.h"
#include "hv_core/error.h"
#include "hv_core/memory.h"
#include "hv_replay/slam_run.h"
#include "tool.h"

namespace {

struct Arguments {
  std::string config;
  std::vector<std::string> bags;
  std::string out;
  int threads = 0;
  bool no_loop = false;
  bool no_pictures = false;
  std::vector<double> drift;
  bool json = false;
};

void Declare(CLI::App& app, Arguments& arguments) {
  app.add_option("--config", arguments.config, "configuration (YAML), e.g. config/hilti_2022.yaml")
      ->required();
  app.add_option("--bag", arguments.bags, "bags, read as one")->required();
  app.add_option("--out", arguments.out, "folder for the results, created when missing")
      ->required();
  app.add_option("--threads", arguments.threads, "threads of one scan's work; 0: as configured")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_flag("--no-loop", arguments.no_loop, "odometry only");
  app.add_flag("--no-pictures", arguments.no_pictures,
               "skip map.png and trajectory.png, whose memory grows with the area");
  app.add_option("--inject-drift", arguments.drift,
                 "make the odometry worse: share of the distance, and degrees of heading a metre")
      ->expected(2);
  app.add_flag("--json", arguments.json, "print the summary as one JSON object");
}

void PrintSummary(const hv::replay::SlamRunSummary& summary, const std::string& out) {
  std::printf("%s\n", summary.odometry.time_layout.c_str());
  for (const auto& [status, count] : summary.scans_by_status) {
    std::printf("scans %-14s %zu\n", status.c_str(), count);
  }
  std::printf("path length          %.2f m\n", summary.path_length_m);
  std::printf("degenerate scans     %zu\n", summary.degenerate_scans);
  if (summary.loops) {
    std::printf("loops                %zu of %zu candidates, %zu keyframes\n", summary.loops->loops,
                summary.loops->candidates, summary.loops->keyframes);
  }
  std::printf("results in           %s\n", out.c_str());
}

hv::replay::SlamRunOptions OptionsOf(const Arguments& arguments) {
  hv::replay::SlamRunOptions options;
  options.loops = !arguments.no_loop;
  options.pictures = !arguments.no_pictures;
  if (!arguments.drift.empty()) options.drift = {arguments.drift[0], arguments.drift[1]};
  return options;
}

int Run(const Arguments& arguments) {
  hv::replay::SlamConfig config;
  hv::ReadConfig(hv::LoadYamlFile(arguments.config), arguments.config, config);
  if (arguments.threads > 0) config.system.odometry.threads = arguments.threads;
  hv::replay::SlamRun run(config, arguments.bags, arguments.out, OptionsOf(arguments));
  const hv::replay::SlamRunSummary summary = run.Run();
  if (arguments.json) {
    std::printf("%s\n", hv::replay::SummaryJson(summary).ToString().c_str());
  } else {
    PrintSummary(summary, arguments.out);
  }
  if (!summary.odometry.error.empty()) throw hv::InputError(summary.odometry.error);
  if (summary.total_ms.empty()) throw hv::InputError("no scan could be tracked");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  hv::KeepFreedMemory();
  CLI::App app("LiDAR-inertial odometry and loop closing over bags, without a ROS master.",
               "hv_slam");
  Arguments arguments;
  Declare(app, arguments);
  return hv::replay::RunTool(app, argc, argv, [&arguments] { return Run(arguments); });
}
