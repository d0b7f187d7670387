#include <algorithm>
#include <cstdio>
#include <string>

#include <yaml-cpp/yaml.h>
#include <CLI/CLI.hpp>

#include "hv_core/config.h"
#include "hv_replay/json.h"
#include "hv_replay/loop_eval.h"
#include "hv_replay/slam_config.h"
#include "tool.h"

namespace {

struct Arguments {
  hv::replay::LoopEvalInput input;
  std::string config;
  std::string out;
  bool json = false;
};

void Declare(CLI::App& app, Arguments& arguments) {
  app.add_option("--poses", arguments.input.poses, "TUM file, one pose a cloud, z up")->required();
  app.add_option("--clouds", arguments.input.clouds, "folder of PCD or PLY files, in order of name")
      ->required();
  app.add_option("--out", arguments.out, "CSV with one row a candidate")->required();
  app.add_option("--config", arguments.config, "configuration (YAML); its section `loop` is used");
  app.add_flag("--blind", arguments.input.blind,
               "place recognition alone: odometry does not restrict the candidates");
  app.add_flag("--json", arguments.json, "print the figures as one JSON object");
}

double Median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void Print(const hv::replay::LoopEvalSummary& summary, bool as_json) {
  const double detect_ms = Median(summary.detect_ms);
  if (as_json) {
    hv::replay::JsonObject json;
    json.AddCount("clouds", summary.clouds)
        .AddCount("submaps", summary.submaps)
        .AddCount("candidates", summary.candidates)
        .AddCount("accepted", summary.accepted)
        .Add("detect_median_ms", detect_ms);
    std::printf("%s\n", json.ToString().c_str());
    return;
  }
  std::printf("clouds               %zu in %zu submaps\n", summary.clouds, summary.submaps);
  std::printf("candidates           %zu, %zu accepted\n", summary.candidates, summary.accepted);
  std::printf("extraction and query %.1f ms (median)\n", detect_ms);
}

int Run(const Arguments& arguments) {
  hv::replay::SlamConfig config;
  if (!arguments.config.empty()) {
    hv::ReadConfig(hv::LoadYamlFile(arguments.config), arguments.config, config);
  }
  Print(hv::replay::EvaluateLoops(arguments.input, config.loop, arguments.out), arguments.json);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Loop candidates among clouds with poses, for precision and recall.",
               "hv_loop_eval");
  Arguments arguments;
  Declare(app, arguments);
  return hv::replay::RunTool(app, argc, argv, [&arguments] { return Run(arguments); });
}
