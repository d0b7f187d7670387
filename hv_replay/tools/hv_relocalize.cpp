#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>
#include <CLI/CLI.hpp>

#include "guess.h"
#include "hv_core/angles.h"
#include "hv_core/config.h"
#include "hv_core/error.h"
#include "hv_core/point_cloud_file.h"
#include "hv_core/pose_covariance.h"
#include "hv_relocalize_ndt/global_localizer.h"
#include "hv_replay/console.h"
#include "hv_replay/json.h"
#include "hv_replay/slam_config.h"
#include "tool.h"

namespace {

using hv::kDegreesPerRadian;
using hv::relocalize::LocalizationResult;
using hv::replay::JsonObject;

constexpr int kNotLocalized = 3;

struct Arguments {
  std::string map;
  std::vector<std::string> clouds;
  std::vector<double> guess;
  std::string config;
  bool json = false;
};

void Declare(CLI::App& app, Arguments& arguments) {
  app.add_option("--map", arguments.map, "map folder, PCD or PLY")->required();
  app.add_option("--cloud", arguments.clouds,
                 "PCD or PLY of a scan in the frame of the LiDAR; each is localised on its own")
      ->required();
  hv::replay::DeclareGuess(app, arguments.guess, "about where the LiDAR was in the map");
  app.add_option("--config", arguments.config,
                 "configuration (YAML); its section `localization` is used");
  app.add_flag("--json", arguments.json, "print the answers as one JSON object");
  app.footer("Exit status: 0 all localised, 3 at least one not localised, 1 an error.");
}

struct Answer {
  std::string cloud;
  LocalizationResult result;
  double ms = 0.0;
};

Answer Localize(const hv::relocalize::GlobalLocalizer& localizer, const std::string& cloud,
                const std::optional<hv::Pose>& guess) {
  Answer answer;
  answer.cloud = cloud;
  hv::relocalize::LocalizationQuery query;
  for (const hv::Point& point : hv::ReadPointCloud(cloud).points) {
    query.points.emplace_back(point.x, point.y, point.z);
  }
  if (guess) query.guess = hv::relocalize::PoseGuess{*guess};
  const auto start = std::chrono::steady_clock::now();
  answer.result = localizer.Locate(query);
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start;
  answer.ms = elapsed.count();
  return answer;
}

JsonObject Json(const Answer& answer) {
  const LocalizationResult& result = answer.result;
  const Eigen::Vector3d& t = result.T_map_scan.translation();
  const Eigen::Quaterniond q(result.T_map_scan.linear());
  const hv::Matrix6d covariance = hv::CovarianceInMapAxes(result.T_map_scan, result.covariance);
  const hv::WeakestDirection weakest = hv::WeakestDirectionOf(covariance);
  JsonObject json;
  json.Add("cloud", answer.cloud)
      .Add("localized", result.localized)
      .Add("reason", result.reason)
      .Add("T_map_lidar", std::vector<double>{t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()})
      .Add("covariance", std::vector<double>(covariance.data(), covariance.data() + 36))
      .Add("weakest_axis",
           std::vector<double>{weakest.axis.x(), weakest.axis.y(), weakest.axis.z()})
      .Add("weakest_sigma_m", weakest.sigma_m)
      .Add("score", result.score.score())
      .Add("fit", result.score.fit)
      .Add("overlap", result.score.overlap)
      .Add("seen_through", result.score.seen_through)
      .Add("margin", result.margin)
      .Add("lead", result.lead)
      .Add("ms", answer.ms);
  return json;
}

void PrintText(const Answer& answer) {
  using hv::replay::Colour;
  const bool colour = hv::replay::ColourOutput();
  const LocalizationResult& result = answer.result;
  std::printf("%s: %s\n", answer.cloud.c_str(),
              result.localized ? hv::replay::Paint("localised", Colour::kGreen, colour).c_str()
                               : (hv::replay::Paint("not localised", Colour::kRed, colour) + ": " +
                                  result.reason)
                                     .c_str());
  const Eigen::Vector3d& t = result.T_map_scan.translation();
  const Eigen::Matrix3d& R = result.T_map_scan.linear();
  const hv::Matrix6d covariance = hv::CovarianceInMapAxes(result.T_map_scan, result.covariance);
  const Eigen::Matrix<double, 6, 1> sigma = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  std::printf("  %s  x %.3f  y %.3f  z %.3f m   roll %.2f  pitch %.2f  yaw %.2f deg\n",
              result.localized ? "T_map_lidar " : "best guess  ", t.x(), t.y(), t.z(),
              kDegreesPerRadian * std::atan2(R(2, 1), R(2, 2)),
              -kDegreesPerRadian * std::asin(R(2, 0)),
              kDegreesPerRadian * std::atan2(R(1, 0), R(0, 0)));
  std::printf("  sigma           %.3f    %.3f    %.3f m        %.2f        %.2f       %.2f deg\n",
              sigma[0], sigma[1], sigma[2], kDegreesPerRadian * sigma[3],
              kDegreesPerRadian * sigma[4], kDegreesPerRadian * sigma[5]);
  const hv::WeakestDirection weakest = hv::WeakestDirectionOf(covariance);
  std::printf("  least certain   %.3f m along (%.2f, %.2f, %.2f)\n", weakest.sigma_m,
              weakest.axis.x(), weakest.axis.y(), weakest.axis.z());
  std::printf("  score %.2f (fit %.2f, overlap %.2f, seen through %.3f), margin %.2f, %.0f ms\n",
              result.score.score(), result.score.fit, result.score.overlap,
              result.score.seen_through, result.margin, answer.ms);
}

int Run(const Arguments& arguments) {
  hv::replay::SlamConfig config;
  if (!arguments.config.empty()) {
    hv::ReadConfig(hv::LoadYamlFile(arguments.config), arguments.config, config);
  }
  const hv::relocalize::RelocalizeConfig& relocalize = config.localization.relocalize;
  const auto map = hv::relocalize::PriorMap::Load(arguments.map, relocalize);
  const hv::relocalize::GlobalLocalizer localizer(relocalize, map);
  std::vector<JsonObject> answers;
  bool all = true;
  for (const std::string& cloud : arguments.clouds) {
    const Answer answer = Localize(localizer, cloud, hv::replay::GuessFrom(arguments.guess));
    all = all && answer.result.localized;
    answers.push_back(Json(answer));
    if (!arguments.json) PrintText(answer);
  }
  if (arguments.json) {
    std::printf("%s\n",
                JsonObject().Add("map", arguments.map).Add("answers", answers).ToString().c_str());
  }
  return all ? 0 : kNotLocalized;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Says where in a saved map scans were taken.", "hv_relocalize");
  Arguments arguments;
  Declare(app, arguments);
  return hv::replay::RunTool(app, argc, argv, [&arguments] { return Run(arguments); });
}
