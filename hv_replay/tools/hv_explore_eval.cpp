#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <yaml-cpp/yaml.h>
#include <CLI/CLI.hpp>

#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "hv_explore_sac/exploration_run.h"
#include "hv_explore_sac/policy/planner_maker.h"
#include "hv_replay/console.h"
#include "hv_replay/json.h"
#include "tool.h"

namespace {

using hv::explore::EvaluationConfig;
using hv::explore::ExplorationMap;
using hv::explore::RunResult;

struct Arguments {
  std::string maps;
  std::vector<std::string> planners;
  std::string weights;
  std::string out;
  std::string paths;
  std::string config;
  int last = 0;
  int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  bool no_loop_guard = false;
  bool json = false;
};

void Declare(CLI::App& app, Arguments& arguments) {
  app.add_option("--maps", arguments.maps,
                 "tiles text file, folder of PNG or PGM, or map_server YAML")
      ->required();
  app.add_option("--last", arguments.last, "only so many maps from the end; else all")
      ->check(CLI::PositiveNumber);
  app.add_option("--planner", arguments.planners,
                 "sac, utility, nearest, ratio, tour, branch, oracle; several with commas")
      ->delimiter(',')
      ->required();
  app.add_option("--weights", arguments.weights, "of the planner `sac`");
  app.add_flag("--no-loop-guard", arguments.no_loop_guard,
               "planners may drive to and fro for ever");
  app.add_option("--out", arguments.out, "CSV with one row a map and planner")->required();
  app.add_option("--paths", arguments.paths,
                 "folder for the way driven in each map, as text and as picture");
  app.add_option("--config", arguments.config,
                 "configuration (YAML) with sections `exploration`, `planner` and `guard`");
  app.add_option("--threads", arguments.threads, "maps explored at a time")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--json", arguments.json, "print the figures as one JSON object");
}

/// The figures of one planner over all maps.
struct Summary {
  std::string planner;
  int maps = 0;
  int done = 0;
  int interventions = 0;
  double travel = 0.0;
  double explored = 0.0;
  double decision_ms = 0.0;
  double step_ms = 0.0;
};

Summary Summarise(const std::vector<RunResult>& results, const std::string& planner) {
  Summary summary;
  summary.planner = planner;
  for (const RunResult& result : results) {
    if (result.planner != planner) continue;
    ++summary.maps;
    summary.done += result.done;
    summary.interventions += result.interventions;
    summary.travel += result.travel;
    summary.explored += result.explored;
    summary.decision_ms += result.decision_ms;
    summary.step_ms += result.step_ms;
  }
  summary.travel /= summary.maps;
  summary.explored /= summary.maps;
  summary.decision_ms /= summary.maps;
  summary.step_ms /= summary.maps;
  return summary;
}

void Print(const std::vector<Summary>& summaries, const std::string& unit, bool as_json) {
  std::vector<hv::replay::JsonObject> objects;
  for (const Summary& each : summaries) {
    hv::replay::JsonObject object;
    object.Add("planner", each.planner)
        .AddCount("maps", each.maps)
        .AddCount("done", each.done)
        .Add("mean_travel", each.travel)
        .Add("mean_explored", each.explored)
        .AddCount("loops_broken", each.interventions)
        .Add("decision_ms", each.decision_ms)
        .Add("step_ms", each.step_ms);
    objects.push_back(object);
    if (as_json) continue;
    std::printf(
        "%-8s %4d of %d done, mean travel %.1f %s, explored %.2f %%, %d loops broken, "
        "%.3f ms a decision, %.3f ms a step\n",
        each.planner.c_str(), each.done, each.maps, each.travel, unit.c_str(),
        100.0 * each.explored, each.interventions, each.decision_ms, each.step_ms);
  }
  if (!as_json) return;
  hv::replay::JsonObject json;
  json.Add("unit", unit).Add("planners", objects);
  std::printf("%s\n", json.ToString().c_str());
}

void WriteTable(const std::vector<RunResult>& results, const std::string& path) {
  std::string text = "map,planner,travel,explored,steps,done,decision_ms\n";
  for (const RunResult& result : results) {
    char row[120];
    std::snprintf(row, sizeof(row), "%.3f,%.5f,%d,%d,%.4f\n", result.travel, result.explored,
                  result.steps, result.done ? 1 : 0, result.decision_ms);
    text += result.map + "," + result.planner + "," + row;
  }
  hv::WriteFile(path, {text});
}

void WritePaths(const std::vector<ExplorationMap>& maps, const std::vector<RunResult>& results,
                const std::string& folder) {
  std::filesystem::create_directories(folder);
  const std::size_t planners = results.size() / maps.size();
  for (std::size_t i = 0; i < results.size(); ++i) {
    const RunResult& run = results[i];
    const std::string stem = folder + "/" + run.map + "_" + run.planner;
    WritePath(maps[i / planners], run, stem + ".txt");
    DrawRun(maps[i / planners], run, stem + ".png");
  }
}

struct EvalFile {
  EvaluationConfig& config;

  void Describe(hv::ConfigVisitor& visitor) {
    visitor.Section("exploration", config.exploration, "the belief, the graph and the simulation");
    visitor.Section("planner", config.planner, "planners that need no learning");
    visitor.Section("guard", config.guard, "against loops and goals that fail");
  }
  void Validate(hv::ConfigProblems& problems) const {
    config.exploration.Validate(problems);
    config.planner.Validate(problems);
    config.guard.Validate(problems);
  }
};

/// Of all planners, `sac` with the weights of the command line.
hv::explore::PlannerFactory MakerOf(const Arguments& arguments) {
  const bool learned = std::count(arguments.planners.begin(), arguments.planners.end(), "sac") > 0;
  if (!learned) return hv::explore::MakePlanner;
  if (arguments.weights.empty()) throw hv::InputError("the planner `sac` needs --weights");
  return [make_learned = hv::explore::PlannerMakerOf("sac", arguments.weights)](
             const std::string& name, const hv::explore::PlannerInputs& inputs) {
    return name == "sac" ? make_learned(inputs) : hv::explore::MakePlanner(name, inputs);
  };
}

std::vector<ExplorationMap> ReadMaps(const Arguments& arguments) {
  std::vector<ExplorationMap> maps = hv::explore::ReadExplorationMaps(arguments.maps);
  if (arguments.last > static_cast<int>(maps.size())) {
    throw hv::InputError("--last " + std::to_string(arguments.last) + ": " + arguments.maps +
                         " holds only " + std::to_string(maps.size()) + " map(s)");
  }
  if (arguments.last > 0) maps.erase(maps.begin(), maps.end() - arguments.last);
  return maps;
}

int Run(const Arguments& arguments) {
  EvaluationConfig config;
  if (!arguments.config.empty()) {
    EvalFile file{config};
    hv::ReadConfig(hv::LoadYamlFile(arguments.config), arguments.config, file);
  }
  config.threads = arguments.threads;
  if (arguments.no_loop_guard) config.guard.enabled = false;
  config.make_planner = MakerOf(arguments);
  const std::vector<ExplorationMap> maps = ReadMaps(arguments);
  std::vector<RunResult> results;
  {
    hv::replay::ProgressLine line("exploring");
    results = hv::explore::Evaluate(
        maps, arguments.planners, config, [&line](std::size_t done, std::size_t total) {
          line.Update(static_cast<double>(done) / static_cast<double>(total),
                      std::to_string(done) + " of " + std::to_string(total) + " runs");
        });
  }
  WriteTable(results, arguments.out);
  if (!arguments.paths.empty()) WritePaths(maps, results, arguments.paths);
  std::vector<Summary> summaries;
  for (const std::string& planner : arguments.planners) {
    summaries.push_back(Summarise(results, planner));
  }
  Print(summaries, maps.front().unit, arguments.json);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Explores maps in simulation and compares planners.", "hv_explore_eval");
  Arguments arguments;
  Declare(app, arguments);
  return hv::replay::RunTool(app, argc, argv, [&arguments] { return Run(arguments); });
}
