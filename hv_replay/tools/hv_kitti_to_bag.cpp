#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>

#include "hv_replay/kitti_to_bag.h"
#include "tool.h"

namespace {

int Convert(const std::string& input, const std::string& output) {
  const hv::replay::KittiConversion conversion = hv::replay::ConvertKitti(input, output);
  std::printf("%s: %zu scans over %.1f s on /points\n", output.c_str(), conversion.scans,
              conversion.duration_s);
  if (!conversion.truth_path.empty()) {
    std::printf("%s: %zu true poses of the LiDAR\n", conversion.truth_path.c_str(),
                conversion.truth_poses);
  }
  for (const std::string& problem : conversion.problems) {
    std::fprintf(stderr, "hv_kitti_to_bag: %s\n", problem.c_str());
  }
  return conversion.problems.empty() ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Converts a sequence of the KITTI odometry benchmark to a bag. Exit status 2: the bag is "
      "written, but scans were damaged.",
      "hv_kitti_to_bag");
  std::string input;
  std::string output;
  app.add_option("--input", input,
                 "folder with velodyne/, and optionally times.txt, calib.txt and poses.txt")
      ->required();
  app.add_option("--out", output, "bag to write; truth.tum goes beside it")->required();
  return hv::replay::RunTool(app, argc, argv, [&] { return Convert(input, output); });
}
