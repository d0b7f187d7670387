#include "map_merge.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "hv_core/error.h"
#include "hv_loop_btc/map_merger.h"
#include "hv_replay/console.h"
#include "hv_replay/json.h"

namespace {

using hv::replay::JsonObject;

struct MergeArguments {
  std::vector<std::string> maps;
  std::string out;
  std::string config;
  bool replace = false;
  bool json = false;
};

/// Early, since joining takes its time. What is replaced must be a map.
void CheckTarget(const MergeArguments& arguments) {
  std::error_code ignored;
  if (!std::filesystem::exists(arguments.out, ignored)) return;
  if (!arguments.replace) {
    throw hv::InputError(arguments.out + ": exists already; --replace replaces a map");
  }
  if (hv::MapFolder::Open(arguments.out).is_plain_cloud()) {
    throw hv::InputError(arguments.out + ": is a file, not a folder for a map");
  }
}

hv::loop::MapMergerConfig ConfigOf(const MergeArguments& arguments, const hv::MapFolder& first) {
  hv::loop::MapMergerConfig config;
  if (!arguments.config.empty()) {
    hv::ReadConfig(hv::LoadYamlFile(arguments.config), arguments.config, config);
    return config;
  }
  const std::string source = first.path() + ": configuration it was made with";
  const YAML::Node node = hv::ParseYaml(first.manifest().configuration, source);
  if (!node.IsNull()) hv::ReadConfig(node, source, config);
  return config;
}

/// A bar for each stage; silent when standard error is not a terminal.
class StageProgress {
 public:
  void Update(const std::string& stage, double share) {
    if (!line_ || stage != stage_) {
      line_.reset();
      line_ = std::make_unique<hv::replay::ProgressLine>(stage);
    }
    stage_ = stage;
    line_->Update(share, "");
  }

 private:
  std::string stage_;
  std::unique_ptr<hv::replay::ProgressLine> line_;
};

JsonObject ToJson(const hv::loop::MergedMap& merged) {
  std::vector<JsonObject> sessions;
  for (const hv::loop::MergedSession& session : merged.sessions) {
    JsonObject json;
    json.Add("path", session.path)
        .AddCount("loops", session.join.loops)
        .AddCount("loops_refused", session.join.refused)
        .AddCount("common_triangles", session.join.triangles)
        .Add("residual_m", session.join.residual_m)
        .Add("residual_deg", session.join.residual_deg);
    sessions.push_back(json);
  }
  JsonObject json;
  json.Add("path", merged.path)
      .AddCount("keyframes", merged.keyframes)
      .AddCount("keyframes_unplaced", merged.unplaced)
      .AddCount("cloud_points", merged.points)
      .Add("joined", sessions);
  return json;
}

void Print(const hv::loop::MergedMap& merged) {
  for (const hv::loop::MergedSession& session : merged.sessions) {
    std::printf(
        "joined       %s by %zu loops (%zu refused; %d common triangles), residual %.1f cm and "
        "%.2f deg\n",
        session.path.c_str(), session.join.loops, session.join.refused, session.join.triangles,
        100.0 * session.join.residual_m, session.join.residual_deg);
  }
  std::printf("map          %s: %zu keyframes, %zu points\n", merged.path.c_str(), merged.keyframes,
              merged.points);
  if (merged.unplaced == 0) return;
  std::printf("left out     %zu keyframes that no loop connects to the others\n", merged.unplaced);
}

int Run(const MergeArguments& arguments) {
  CheckTarget(arguments);
  std::vector<hv::MapFolder> maps;
  for (const std::string& path : arguments.maps) maps.push_back(hv::MapFolder::Open(path));
  const hv::loop::MapMerger merger(ConfigOf(arguments, maps.front()));
  hv::loop::MergedMap merged;
  {
    StageProgress progress;
    merged = merger.Merge(maps, arguments.out, [&progress](const std::string& stage, double share) {
      progress.Update(stage, share);
    });
  }
  if (arguments.json) {
    std::printf("%s\n", ToJson(merged).ToString().c_str());
  } else {
    Print(merged);
  }
  return 0;
}

}  // namespace

std::function<int()> AddMergeCommand(CLI::App& app) {
  const auto arguments = std::make_shared<MergeArguments>();
  CLI::App* command =
      app.add_subcommand("merge", "join maps of several sessions, in the frame of the first");
  constexpr int kMostMaps = 1000;
  command->add_option("MAPS", arguments->maps, "map folders")->required()->expected(2, kMostMaps);
  command->add_option("--out", arguments->out, "folder for the joined map")->required();
  command->add_option("--config", arguments->config,
                      "configuration (YAML); its sections `loop` and `map` are used instead of "
                      "those that the first map was made with");
  command->add_flag("--replace", arguments->replace, "replace a map that is at --out");
  command->add_flag("--json", arguments->json, "print one JSON object");
  return [arguments] { return Run(*arguments); };
}
