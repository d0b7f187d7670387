#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <yaml-cpp/yaml.h>

#include <CLI/CLI.hpp>

#include "hv_core/error.h"
#include "hv_sim/dataset_writers.h"

namespace {

using hv::sim::DatasetOptions;
using hv::sim::DatasetSummary;
using hv::sim::RecordingConfig;

struct Arguments {
  std::string world = "construction";
  std::string trajectory = "walk";
  std::vector<std::string> formats{"hilti"};
  double duration_s = 60.0;
  double skip_s = 0.0;
  int seed = 1;
  int world_seed = -1;
  std::string out;
  std::string config;
  std::vector<std::string> faults;
  double point_share = 1.0;
  int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  bool no_noise = false;
  bool no_people = false;
  bool json = false;
};

std::string Join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string Footer() {
  std::ostringstream text;
  text << "Faults, as NAME or NAME:KEY=VALUE,KEY=VALUE (defaults shown):\n";
  for (const hv::sim::FaultKind& kind : hv::sim::FaultKinds()) {
    text << "  " << kind.name;
    char separator = ':';
    for (const auto& [key, value] : kind.parameters) {
      text << separator << key << '=' << value;
      separator = ',';
    }
    text << "\n      " << kind.description << '\n';
  }
  text << "\nWith one format its files lie in DIR, with several in DIR/<format>.";
  return text.str();
}

void Declare(CLI::App& app, Arguments& arguments) {
  app.add_option("--world", arguments.world,
                 "one of " + Join(hv::sim::WorldNames()) + "; or the YAML of a floor plan")
      ->capture_default_str();
  app.add_option("--trajectory", arguments.trajectory, "one of " + Join(hv::sim::MotionStyles()))
      ->capture_default_str();
  app.add_option("--format", arguments.formats,
                 "one or more of " + Join(hv::sim::FormatNames()) + ", separated by commas")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  app.add_option("--duration", arguments.duration_s, "length [s]")->capture_default_str();
  app.add_option("--skip", arguments.skip_s,
                 "leaves out the first seconds; more than 2 starts in motion [s]")
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "of clutter, motion and noise")->capture_default_str();
  app.add_option("--world-seed", arguments.world_seed,
                 "of clutter alone, for another run in the same world; below 0: as --seed")
      ->capture_default_str();
  app.add_option("--out", arguments.out, "directory for the results")->required();
  app.add_option("--config", arguments.config,
                 "YAML with further settings, as simulation.yaml of an earlier run");
  app.add_option("--fault", arguments.faults, "something that goes wrong; may be repeated")
      ->allow_extra_args(false);
  app.add_option("--point-share", arguments.point_share, "share of LiDAR columns kept, in (0, 1]")
      ->capture_default_str();
  app.add_option("--threads", arguments.threads, "threads that cast rays")->capture_default_str();
  app.add_flag("--no-noise", arguments.no_noise, "perfect LiDAR and IMU");
  app.add_flag("--no-people", arguments.no_people, "nobody walks around");
  app.add_flag("--json", arguments.json, "print the summary as one JSON object");
  app.footer(Footer());
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return std::string("hv_simulate: ") + error.what() + "\n";
  });
}

/// The settings of the file, overridden by what the command line names explicitly.
RecordingConfig MakeConfig(const CLI::App& app, const Arguments& arguments,
                           const std::string& format) {
  RecordingConfig config;
  config.suite = hv::sim::DefaultSuite(format);
  if (!arguments.config.empty()) {
    hv::ReadConfig(hv::LoadYamlFile(arguments.config), arguments.config, config);
  }
  const bool no_file = arguments.config.empty();
  const auto given = [&](const char* name) { return no_file || app.count(name) > 0; };
  config.format = format;
  if (given("--world")) config.world = arguments.world;
  if (given("--trajectory")) config.motion.style = arguments.trajectory;
  if (given("--duration")) config.motion.duration_s = arguments.duration_s;
  if (given("--skip")) config.motion.skip_s = arguments.skip_s;
  if (given("--seed")) config.seed = arguments.seed;
  if (given("--world-seed")) config.world_seed = arguments.world_seed;
  if (given("--point-share")) config.point_share = arguments.point_share;
  if (arguments.no_people) config.people = false;
  if (arguments.no_noise) config.lidar_noise = config.suite.imu.noise = false;
  hv::ConfigProblems problems;
  config.Validate(problems);
  if (!problems.lines().empty()) throw hv::InputError(problems.lines().front());
  return config;
}

hv::sim::Recording::Progress ProgressBar(const std::string& title) {
  if (isatty(STDERR_FILENO) == 0) return nullptr;
  return [title](double share) {
    constexpr int kWidth = 40;
    const auto done = static_cast<int>(share * kWidth);
    std::fprintf(stderr, "\r%s [%s%s] %3d%%%s", title.c_str(),
                 std::string(static_cast<std::size_t>(done), '#').c_str(),
                 std::string(static_cast<std::size_t>(kWidth - done), '.').c_str(),
                 static_cast<int>(share * 100.0), share >= 1.0 ? "\n" : "");
  };
}

struct Result {
  std::string format;
  DatasetSummary summary;
  double seconds = 0.0;
};

Result Simulate(const RecordingConfig& config, const Arguments& arguments) {
  const auto begin = std::chrono::steady_clock::now();
  const hv::sim::World world = hv::sim::MakeWorld(config.world, config.clutter_seed());
  const hv::sim::Recording recording(world, config);
  DatasetOptions options;
  options.directory = arguments.out;
  if (arguments.formats.size() > 1) options.directory += "/" + config.format;
  for (const std::string& text : arguments.faults) {
    options.faults.push_back(hv::sim::ParseFault(text));
  }
  options.threads = arguments.threads;
  options.progress = ProgressBar(config.world + " " + config.motion.style + " " + config.format);
  Result result{config.format, hv::sim::WriteDataset(recording, options), 0.0};
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  result.seconds = elapsed.count();
  return result;
}

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

void PrintJson(const std::vector<Result>& results) {
  std::cout << "{\"recordings\": [";
  for (std::size_t i = 0; i < results.size(); ++i) {
    const DatasetSummary& summary = results[i].summary;
    std::cout << (i > 0 ? ", " : "") << "{\"format\": " << Quoted(results[i].format)
              << ", \"scans\": " << summary.scans << ", \"points\": " << summary.points
              << ", \"imu_samples\": " << summary.imu_samples
              << ", \"lost_messages\": " << summary.lost_messages
              << ", \"path_length_m\": " << summary.path_length_m
              << ", \"elapsed_s\": " << results[i].seconds << ", \"files\": [";
    for (std::size_t k = 0; k < summary.files.size(); ++k) {
      std::cout << (k > 0 ? ", " : "") << Quoted(summary.files[k]);
    }
    std::cout << "]}";
  }
  std::cout << "]}" << std::endl;
}

void PrintText(const std::vector<Result>& results) {
  for (const Result& result : results) {
    const DatasetSummary& summary = result.summary;
    std::cout << result.format << ": " << summary.scans << " scans, " << summary.points
              << " points, " << summary.imu_samples << " IMU samples, " << summary.path_length_m
              << " m of path, " << summary.lost_messages << " messages lost to faults, "
              << result.seconds << " s\n";
    for (const std::string& file : summary.files) std::cout << "  " << file << '\n';
  }
}

/// A configuration file may choose the format; the command line has the last word.
void ChooseFormat(const CLI::App& app, Arguments& arguments) {
  if (arguments.config.empty() || app.count("--format") > 0) return;
  RecordingConfig config;
  hv::ReadConfig(hv::LoadYamlFile(arguments.config), arguments.config, config);
  arguments.formats = {config.format};
}

void Run(const CLI::App& app, Arguments& arguments) {
  if (arguments.threads < 1) throw hv::InputError("--threads: must be at least 1");
  ChooseFormat(app, arguments);
  std::vector<RecordingConfig> configs;
  for (const std::string& format : arguments.formats) {
    configs.push_back(MakeConfig(app, arguments, format));
  }
  for (const std::string& fault : arguments.faults) hv::sim::ParseFault(fault);
  std::vector<Result> results;
  for (const RecordingConfig& config : configs) results.push_back(Simulate(config, arguments));
  if (arguments.json) {
    PrintJson(results);
  } else {
    PrintText(results);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Simulates LiDAR and IMU recordings with exact truth.", "hv_simulate");
  Arguments arguments;
  Declare(app, arguments);
  CLI11_PARSE(app, argc, argv);
  try {
    Run(app, arguments);
  } catch (const std::exception& error) {
    std::cerr << "hv_simulate: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}
