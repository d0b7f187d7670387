#include <cstdio>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>
#include <CLI/CLI.hpp>

#include "hv_core/config.h"
#include "hv_replay/bag_check.h"
#include "hv_replay/bag_reader.h"
#include "tool.h"

namespace {

struct Arguments {
  std::vector<std::string> bags;
  std::string config;
  hv::replay::BagCheckOptions options;
  bool json = false;
};

void Declare(CLI::App& app, Arguments& arguments) {
  app.add_option("--bag", arguments.bags, "bag, or several that belong together")->required();
  app.add_option("--config", arguments.config,
                 "configuration of the odometry (YAML): topics, point decoding and the extrinsic "
                 "to judge; without it topics are found by type");
  app.add_option("--odometry-seconds", arguments.options.odometry_s,
                 "data from which the rotations of both sensors are compared [s]; 0: skip")
      ->capture_default_str();
  app.add_option("--start", arguments.options.start_s, "where that stretch starts [s]")
      ->capture_default_str();
  app.add_flag("--json", arguments.json, "print one JSON object");
}

int Check(Arguments& arguments) {
  hv::lio::SystemConfig config;
  hv::replay::BagTopics topics;
  if (!arguments.config.empty()) {
    hv::ReadConfig(hv::LoadYamlFile(arguments.config), arguments.config, config);
    topics = {config.input.points_topic, config.input.imu_topic};
    arguments.options.compare_extrinsic = true;
  }
  const hv::replay::ImuNeed need =
      config.odometry.use_imu ? hv::replay::ImuNeed::kOptional : hv::replay::ImuNeed::kIgnored;
  hv::replay::BagReader reader(arguments.bags, topics, need);
  const hv::replay::BagCheck check = hv::replay::CheckBag(reader, config, arguments.options);
  const std::string text = arguments.json
                               ? hv::replay::CheckJson(check).ToString() + "\n"
                               : hv::replay::CheckReport(check, hv::replay::ColourOutput());
  std::fputs(text.c_str(), stdout);
  return check.HasErrors() ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Looks for what spoils LiDAR-inertial odometry in a bag: fields, point times, gaps, rates, "
      "units, clocks, extrinsics. Exit status 1 when it finds an error.",
      "hv_check_bag");
  Arguments arguments;
  Declare(app, arguments);
  return hv::replay::RunTool(app, argc, argv, [&arguments] { return Check(arguments); });
}
