#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "hv_core/error.h"
#include "hv_core/point_cloud_file.h"
#include "hv_core/trajectory.h"
#include "hv_sim/lidar.h"
#include "hv_sim/view_sampler.h"

namespace {

struct Arguments {
  std::string world = "office";
  int world_seed = 1;
  int seed = 1;
  int count = 50;
  int revolutions = 1;
  std::string away_from;
  std::string out;
  bool no_people = false;
  hv::sim::ViewLimits limits;
};

void Declare(CLI::App& app, Arguments& arguments) {
  app.add_option("--world", arguments.world, "a world of hv_simulate")->capture_default_str();
  app.add_option("--world-seed", arguments.world_seed,
                 "of the clutter in it: --seed of hv_simulate")
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "of places and noise")->capture_default_str();
  app.add_option("--count", arguments.count, "scans")->capture_default_str();
  app.add_option("--revolutions", arguments.revolutions, "of the LiDAR, as one cloud each")
      ->capture_default_str();
  app.add_option("--away-from", arguments.away_from, "TUM file of places to keep away from");
  app.add_option("--distance", arguments.limits.keep_away_m, "how far from them [m]")
      ->capture_default_str();
  app.add_flag("--no-people", arguments.no_people, "nobody walks around");
  app.add_option("--out", arguments.out,
                 "folder for NNN.pcd, in the frame of the LiDAR, and poses.tum")
      ->required();
}

std::vector<Eigen::Vector3d> PlacesOf(const std::string& path) {
  std::vector<Eigen::Vector3d> places;
  if (path.empty()) return places;
  const hv::Trajectory trajectory = hv::ReadTum(path);
  for (const hv::StampedPose& pose : trajectory.poses()) {
    const Eigen::Vector3d place = pose.pose.translation();
    if (places.empty() || (place - places.back()).norm() > 0.2) places.push_back(place);
  }
  return places;
}

/// All revolutions that a LiDAR at rest makes, people moving meanwhile.
std::vector<hv::Point> Look(const hv::sim::LidarSimulator& lidar, const hv::Pose& view, int number,
                            int revolutions) {
  std::vector<hv::Point> points;
  for (int i = 0; i < revolutions; ++i) {
    const double start_s = 20.0 * number + i * lidar.model().period();
    const hv::Scan scan = lidar.Sweep(start_s, [&view](double) { return view; });
    points.insert(points.end(), scan.points.begin(), scan.points.end());
  }
  return points;
}

void Run(const Arguments& arguments) {
  if (arguments.count < 1) throw hv::InputError("--count: must be at least 1");
  if (arguments.revolutions < 1) throw hv::InputError("--revolutions: must be at least 1");
  const auto seed = static_cast<std::uint32_t>(arguments.seed);
  const hv::sim::World world =
      hv::sim::MakeWorld(arguments.world, static_cast<std::uint32_t>(arguments.world_seed));
  const std::vector<hv::Pose> views = hv::sim::SampleViews(world, arguments.count, arguments.limits,
                                                           PlacesOf(arguments.away_from), seed);
  if (views.size() < static_cast<std::size_t>(arguments.count)) {
    throw hv::InputError("only " + std::to_string(views.size()) + " places are free in " +
                         arguments.world);
  }
  hv::sim::LidarOptions options;
  options.people = !arguments.no_people;
  const hv::sim::LidarSimulator lidar(world, hv::sim::PandarXt32(), options, seed + 1000U);
  std::filesystem::create_directories(arguments.out);
  hv::Trajectory truth;
  for (std::size_t i = 0; i < views.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof(name), "/%03zu.pcd", i);
    hv::WritePcd(arguments.out + name,
                 Look(lidar, views[i], static_cast<int>(i), arguments.revolutions));
    truth.Append(hv::Time::FromSeconds(static_cast<double>(i)), views[i]);
  }
  hv::WriteTum(arguments.out + "/poses.tum", truth);
  std::cout << views.size() << " scans of " << arguments.world << " in " << arguments.out << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Simulates scans of a LiDAR that stands at random places of a world.",
               "hv_simulate_scans");
  Arguments arguments;
  Declare(app, arguments);
  CLI11_PARSE(app, argc, argv);
  try {
    Run(arguments);
  } catch (const std::exception& error) {
    std::cerr << "hv_simulate_scans: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}
