#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "hv_core/error.h"
#include "hv_core/map_folder.h"
#include "hv_replay/console.h"
#include "hv_replay/map_report.h"
#include "map_merge.h"
#include "tool.h"

namespace {

struct Arguments {
  std::string map;
  bool json = false;
  std::string cloud;
  std::string grid;
  std::string occupancy;
};

/// Subcommand with what all of them take.
CLI::App* AddCommand(CLI::App& app, const char* name, const char* description,
                     Arguments& arguments) {
  CLI::App* command = app.add_subcommand(name, description);
  command->add_option("MAP", arguments.map, "map folder, or a single PCD or PLY file")->required();
  command->add_flag("--json", arguments.json, "print one JSON object");
  return command;
}

void DeclareExport(CLI::App& command, Arguments& arguments) {
  command.add_option("--cloud", arguments.cloud, "write the map cloud to this .pcd or .ply");
  command.add_option("--grid", arguments.grid,
                     "write grid.pgm and grid.yaml for map_server into this folder");
  command.add_option("--bt", arguments.occupancy, "write the OctoMap to this .bt file");
}

void Print(const std::string& text) { std::fputs(text.c_str(), stdout); }

int Info(const Arguments& arguments) {
  const hv::replay::MapReport report = hv::replay::ReportMap(hv::MapFolder::Open(arguments.map));
  Print(arguments.json ? hv::replay::MapReportJson(report).ToString() + "\n"
                       : hv::replay::MapReportText(report));
  return 0;
}

int Verify(const Arguments& arguments) {
  const hv::MapFolder map = hv::MapFolder::Open(arguments.map);
  {
    hv::replay::ProgressLine progress("checking");
    map.Verify([&progress](double share) { progress.Update(share, ""); });
  }
  hv::replay::JsonObject json;
  json.Add("path", map.path()).Add("whole", true);
  json.AddCount("files", map.is_plain_cloud() ? 1 : map.manifest().files.size());
  Print(arguments.json ? json.ToString() + "\n" : map.path() + ": whole\n");
  return 0;
}

void MakeFolder(const std::string& folder) {
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) throw hv::InputError(folder + ": cannot be created (" + error.message() + ")");
}

void CopyTo(const std::string& from, const std::string& to) {
  std::error_code error;
  const auto overwrite = std::filesystem::copy_options::overwrite_existing;
  std::filesystem::copy_file(from, to, overwrite, error);
  if (error) throw hv::InputError(to + ": cannot be written (" + error.message() + ")");
}

int Export(const Arguments& arguments) {
  const hv::MapFolder map = hv::MapFolder::Open(arguments.map);
  std::vector<std::string> written;
  if (!arguments.cloud.empty()) {
    hv::WritePointCloud(arguments.cloud, map.ReadCloud().points);
    written.push_back(arguments.cloud);
  }
  if (!arguments.grid.empty()) {
    const hv::OccupancyGrid grid = map.ReadGrid();
    MakeFolder(arguments.grid);
    hv::WriteGrid(arguments.grid, "grid", grid);
    written.push_back(arguments.grid + "/grid.yaml");
  }
  if (!arguments.occupancy.empty()) {
    CopyTo(map.OccupancyPath(), arguments.occupancy);
    written.push_back(arguments.occupancy);
  }
  if (written.empty()) throw hv::InputError("nothing to export: give --cloud, --grid or --bt");
  if (arguments.json) Print(hv::replay::JsonObject().Add("written", written).ToString() + "\n");
  for (const std::string& path : written) {
    if (!arguments.json) Print(path + "\n");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Looks into saved maps, checks, exports and joins them.", "hv_map");
  app.require_subcommand(1);
  Arguments arguments;
  const CLI::App* info = AddCommand(app, "info", "what a map holds", arguments);
  const CLI::App* verify =
      AddCommand(app, "verify", "read every file and compare all checksums", arguments);
  DeclareExport(*AddCommand(app, "export", "write parts of a map for other programs", arguments),
                arguments);
  const std::function<int()> merge = AddMergeCommand(app);
  return hv::replay::RunTool(app, argc, argv, [&] {
    if (app.got_subcommand("merge")) return merge();
    if (info->parsed()) return Info(arguments);
    return verify->parsed() ? Verify(arguments) : Export(arguments);
  });
}
