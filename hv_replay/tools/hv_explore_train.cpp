#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <tbb/global_control.h>
#include <yaml-cpp/yaml.h>
#include <CLI/CLI.hpp>

#include "hv_core/file_io.h"
#include "hv_explore_sac/train/trainer.h"
#include "hv_replay/console.h"
#include "hv_replay/curve_plot.h"
#include "mpi_ranks.h"
#include "tool.h"

namespace {

using hv::explore::CurvePoint;
using hv::explore::Trainer;

struct Arguments {
  std::string maps;
  std::string config;
  std::string out;
  std::string labels;
  std::string from;
  bool resume = false;
  int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
};

void Declare(CLI::App& app, Arguments& arguments) {
  app.add_option("--maps", arguments.maps,
                 "tiles text file, or folder of PNG or PGM; see `split` in the configuration")
      ->required();
  app.add_option("--config", arguments.config, "configuration of the training (YAML)")->required();
  app.add_option("--out", arguments.out, "folder of the training, created when missing")
      ->required();
  CLI::Option* resume =
      app.add_flag("--resume", arguments.resume, "go on from the last round that --out holds");
  CLI::Option* labels =
      app.add_option("--labels", arguments.labels,
                     "folder of a training whose first measurements are taken over, for trying "
                     "other networks or other learning on them")
          ->excludes(resume);
  app.add_option("--from", arguments.from,
                 "weights to begin with, as for other places or another sensor; else the planner "
                 "utility and networks at random")
      ->excludes(resume)
      ->excludes(labels);
  app.add_option("--threads", arguments.threads, "of each process")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

/// A progress line for each thing that is done, from several threads.
class Progress {
 public:
  void Update(const std::string& what, double share) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (what != what_) line_.emplace(what_ = what);
    line_->Update(share, "");
  }

 private:
  std::mutex mutex_;
  std::string what_;
  std::optional<hv::replay::ProgressLine> line_;
};

hv::replay::NamedCurve CurveOf(const std::vector<CurvePoint>& points, const std::string& name,
                               double CurvePoint::*value) {
  hv::replay::NamedCurve curve{name, {}, {}};
  for (const CurvePoint& point : points) {
    curve.x.push_back(point.updates);
    curve.y.push_back(point.*value);
  }
  return curve;
}

void Draw(const std::vector<CurvePoint>& points, const std::string& path) {
  hv::replay::PlotCurves({{"Gain of the choices over utility's, in states kept aside",
                           "updates",
                           "[cells]",
                           {CurveOf(points, "gain", &CurvePoint::gain)}},
                          {"Travel on the maps for validation, as a share of utility's",
                           "updates",
                           "",
                           {CurveOf(points, "share", &CurvePoint::share)}}},
                         "Training of the exploration policy", path);
}

int Run(const Arguments& arguments, hv::explore::Ranks& ranks) {
  hv::explore::TrainConfig config;
  hv::ReadConfig(hv::LoadYamlFile(arguments.config), arguments.config, config);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(arguments.threads));
  const std::vector<hv::explore::ExplorationMap> maps =
      hv::explore::ReadExplorationMaps(arguments.maps);
  Progress progress;
  Trainer trainer(config, maps, arguments.out, ranks, [&](const std::string& what, double share) {
    if (ranks.rank() == 0) progress.Update(what, share);
  });
  if (!arguments.labels.empty()) trainer.TakeLabels(arguments.labels);
  if (!arguments.from.empty()) trainer.BeginWith(arguments.from);
  if (arguments.resume) trainer.Resume();
  trainer.Run();
  if (ranks.rank() != 0) return 0;
  hv::WriteFile(arguments.out + "/config.yaml", {hv::ToYaml(config)});
  Draw(trainer.curve(), arguments.out + "/curve.png");
  std::printf("best policy drives %.2f %% of utility's travel on the maps for validation\n",
              100.0 * trainer.best_share());
  std::printf("results in %s\n", arguments.out.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::unique_ptr<hv::explore::Ranks> ranks = MakeRanks(&argc, &argv);
  CLI::App app("Trains the policy of the planner `sac` in simulation; mpirun shares the work out.",
               "hv_explore_train");
  Arguments arguments;
  Declare(app, arguments);
  return hv::replay::RunTool(app, argc, argv, [&] { return Run(arguments, *ranks); });
}
