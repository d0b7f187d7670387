#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "hv_core/error.h"
#include "hv_core/trajectory.h"
#include "hv_replay/error_report.h"
#include "hv_replay/plot.h"
#include "hv_replay/trajectory_error.h"
#include "tool.h"

namespace {

struct Arguments {
  std::string reference;
  std::string estimate;
  std::string align = "se3";
  std::vector<std::string> align_by;
  std::string plot;
  bool json = false;
  hv::replay::TrajectoryErrorOptions options;
};

void Declare(CLI::App& app, Arguments& arguments) {
  app.add_option("--reference", arguments.reference, "true trajectory (TUM)")->required();
  app.add_option("--estimate", arguments.estimate, "trajectory to judge (TUM)")->required();
  app.add_option("--align", arguments.align, "se3, yaw or none")->capture_default_str();
  app.add_option("--align-by", arguments.align_by,
                 "TUM files REFERENCE ESTIMATE in the same two frames: lay these over each other, "
                 "and judge --estimate where it then lies")
      ->expected(2);
  app.add_option("--max-gap", arguments.options.max_gap_s, "longest gap to interpolate across [s]")
      ->capture_default_str();
  app.add_option("--plot", arguments.plot, "draw paths and errors into this picture (.png)");
  app.add_flag("--json", arguments.json, "print one JSON object");
}

/// The trajectory in the frame of the reference, when other files say how the two frames lie.
hv::Trajectory Placed(const hv::Trajectory& estimate, Arguments& arguments) {
  if (arguments.align_by.empty()) return estimate;
  const hv::Pose T_reference_estimate =
      hv::replay::CompareTrajectories(hv::ReadTum(arguments.align_by[0]),
                                      hv::ReadTum(arguments.align_by[1]), arguments.options)
          .T_reference_estimate;
  arguments.options.alignment = hv::replay::Alignment::kNone;
  std::vector<hv::StampedPose> placed;
  for (const hv::StampedPose& pose : estimate.poses()) {
    placed.push_back({pose.stamp, T_reference_estimate * pose.pose});
  }
  return hv::Trajectory(std::move(placed));
}

int Compare(Arguments& arguments) {
  arguments.options.alignment = hv::replay::ParseAlignment(arguments.align);
  const hv::Trajectory estimate = Placed(hv::ReadTum(arguments.estimate), arguments);
  const hv::replay::TrajectoryError error = hv::replay::CompareTrajectories(
      hv::ReadTum(arguments.reference), estimate, arguments.options);
  if (!arguments.plot.empty()) {
    const std::string name = std::filesystem::path(arguments.estimate).filename().string();
    hv::replay::PlotError(error, name, arguments.plot);
  }
  const std::string text =
      arguments.json
          ? hv::replay::ErrorJson(error, arguments.options.alignment).ToString() + "\n"
          : hv::replay::ErrorTable(error, arguments.options.alignment, hv::replay::ColourOutput());
  std::fputs(text.c_str(), stdout);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Absolute and relative pose error of a trajectory against a reference.", "hv_ape");
  Arguments arguments;
  Declare(app, arguments);
  return hv::replay::RunTool(app, argc, argv, [&arguments] { return Compare(arguments); });
}
