#include <cstdio>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>
#include <CLI/CLI.hpp>

#include "hv_core/config.h"
#include "hv_core/error.h"
#include "hv_replay/json.h"
#include "hv_replay/relocalize_eval.h"
#include "hv_replay/slam_config.h"
#include "tool.h"

namespace {

struct Arguments {
  hv::replay::RelocalizeTrials trials;
  std::vector<double> perturbation;
  std::vector<double> guess_window;
  std::vector<double> resolutions_m;
  std::string config;
  std::string out;
  bool json = false;
};

void Declare(CLI::App& app, Arguments& arguments) {
  hv::replay::RelocalizeTrials& trials = arguments.trials;
  app.add_option("--map", trials.map, "map folder, PCD or PLY")->required();
  app.add_option("--clouds", trials.clouds, "folder of PCD or PLY files to localise")->required();
  app.add_option("--poses", trials.poses,
                 "TUM file with the true pose of each cloud; without, none lies in the map");
  app.add_option("--map-truth", trials.map_truth,
                 "TUM file with the truth of the run that made the map, in the frame of --poses");
  app.add_option("--count", trials.count, "trials; the clouds are used again and again")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--perturb", arguments.perturbation,
                 "guesses this far from the truth [m] [deg]; without, no guess")
      ->expected(2);
  app.add_option("--guess-window", arguments.guess_window,
                 "how far from guesses is searched [m] [deg]; without, as configured")
      ->expected(2);
  app.add_flag("--ndt-alone", trials.ndt_alone, "only the alignment from the guess");
  app.add_option("--resolutions", arguments.resolutions_m, "levels of the alignment [m]")
      ->expected(-1);
  app.add_option("--changed-share", trials.changed_share,
                 "share of the columns of the map that change places before")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--seed", trials.seed, "of perturbations and changes")->capture_default_str();
  app.add_option("--out", arguments.out, "CSV with one row a trial")->required();
  app.add_option("--config", arguments.config,
                 "configuration (YAML); its section `localization` is used");
  app.add_flag("--json", arguments.json, "print the figures as one JSON object");
}

void Print(const hv::replay::RelocalizeSummary& summary, bool as_json) {
  if (as_json) {
    hv::replay::JsonObject json;
    json.AddCount("trials", summary.trials)
        .AddCount("answered", summary.answered)
        .AddCount("successes", summary.successes)
        .Add("rmse_m", summary.rmse_m)
        .Add("mean_m", summary.mean_m)
        .Add("error_in_sigmas", summary.error_in_sigmas)
        .Add("median_ms", summary.median_ms)
        .Add("max_ms", summary.max_ms)
        .Add("load_ms", summary.load_ms);
    std::printf("%s\n", json.ToString().c_str());
    return;
  }
  std::printf("trials     %zu, %zu answered, %zu within 0.10 m and 3 deg\n", summary.trials,
              summary.answered, summary.successes);
  std::printf("of these   RMSE %.2f cm, mean %.2f cm, %.2f times what the covariances say\n",
              100.0 * summary.rmse_m, 100.0 * summary.mean_m, summary.error_in_sigmas);
  std::printf("time       %.0f ms (median), %.0f ms (most); map %.0f ms\n", summary.median_ms,
              summary.max_ms, summary.load_ms);
}

int Run(Arguments arguments) {
  hv::replay::SlamConfig config;
  if (!arguments.config.empty()) {
    hv::ReadConfig(hv::LoadYamlFile(arguments.config), arguments.config, config);
  }
  if (!arguments.resolutions_m.empty()) {
    config.localization.relocalize.ndt.resolutions_m = arguments.resolutions_m;
    hv::ConfigProblems problems;
    config.localization.Validate(problems);
    if (!problems.lines().empty()) throw hv::InputError(problems.lines().front());
  }
  if (!arguments.perturbation.empty()) {
    arguments.trials.perturbation = {arguments.perturbation[0], arguments.perturbation[1]};
  }
  if (!arguments.guess_window.empty()) {
    arguments.trials.guess_radius_m = arguments.guess_window[0];
    arguments.trials.guess_heading_deg = arguments.guess_window[1];
  }
  Print(hv::replay::TryRelocalization(arguments.trials, config.localization.relocalize,
                                      arguments.out),
        arguments.json);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Relocalises many clouds in a map and compares with the truth.",
               "hv_relocalize_eval");
  Arguments arguments;
  Declare(app, arguments);
  return hv::replay::RunTool(app, argc, argv, [&arguments] { return Run(arguments); });
}
