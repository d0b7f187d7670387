#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>

#include "hv_replay/nclt.h"
#include "hv_replay/nclt_to_bag.h"
#include "tool.h"

namespace {

int Convert(const std::string& input, const std::string& output) {
  const hv::replay::NcltConversion conversion = hv::replay::ConvertNclt(input, output);
  std::printf("%s: %zu sweeps over %.1f s on /points, %zu samples on /imu_raw\n", output.c_str(),
              conversion.sweeps, conversion.duration_s, conversion.imu_samples);
  if (!conversion.truth_path.empty()) {
    std::printf("%s: %zu true poses of imu_link, z up\n", conversion.truth_path.c_str(),
                conversion.truth_poses);
  }
  const Eigen::Vector3d t = hv::replay::nclt::T_imu_velodyne().translation();
  std::printf("T_imu_lidar: translation [%.3f, %.3f, %.3f] m, no rotation\n", t.x(), t.y(), t.z());
  for (const std::string& problem : conversion.problems) {
    std::fprintf(stderr, "hv_nclt_to_bag: %s\n", problem.c_str());
  }
  return conversion.problems.empty() ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Converts a session of the NCLT data set to a bag. Exit status 2: the bag is written, but "
      "parts of the input were damaged.",
      "hv_nclt_to_bag");
  std::string input;
  std::string output;
  app.add_option("--input", input,
                 "folder with velodyne_hits.bin or velodyne_sync/, ms25.csv, groundtruth_*.csv")
      ->required();
  app.add_option("--out", output, "bag to write; the truth goes beside it as .tum")->required();
  return hv::replay::RunTool(app, argc, argv, [&] { return Convert(input, output); });
}
