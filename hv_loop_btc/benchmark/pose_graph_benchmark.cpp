#include <vector>

#include <benchmark/benchmark.h>

#include "world_graph.h"

namespace hv::loop {
namespace {

constexpr std::size_t kKeyframes = 5000;
constexpr std::size_t kLoops = 500;

/// 5000 keyframes, 500 true loops and as many false ones as make the given percentage of all.
struct Setting {
  explicit Setting(std::int64_t percent_false) {
    loops = world.TrueLoops(kLoops);
    const auto percent = static_cast<std::size_t>(percent_false);
    Append(world.RandomFalseLoops(kLoops * percent / (100 - percent)), loops);
    PoseGraph clean = BuildGraph(world, {loops.begin(), loops.begin() + kLoops});
    clean.Optimize();
    clean_error = world.RmsError(clean.Poses());
  }

  GraphWorld world{CityDrive(kKeyframes, 50, 6, 1), WorldNoise(), 2};
  std::vector<GraphEdge> loops;
  double clean_error = 0.0;
};

void Report(const Setting& setting, const PoseGraph& graph, benchmark::State& state) {
  const AcceptedLoops accepted = CountAccepted(graph, kLoops);
  state.counters["error_ratio"] = setting.world.RmsError(graph.Poses()) / setting.clean_error;
  state.counters["lost"] = static_cast<double>(kLoops - accepted.good);
  state.counters["false"] = static_cast<double>(accepted.bad);
}

/// All loops at once. With `gate` 0, odometry alone refuses none: graduated non-convexity sorts out
/// every false loop.
void Optimize(benchmark::State& state) {
  const Setting setting(state.range(0));
  PoseGraphConfig config;
  if (state.range(1) == 0) config.odometry_gate_scale = 1e6;
  const PoseGraph fresh = BuildGraph(setting.world, setting.loops, config);
  PoseGraph graph = fresh;
  for (auto _ : state) {
    state.PauseTiming();
    graph = fresh;
    state.ResumeTiming();
    graph.Optimize();
  }
  Report(setting, graph, state);
}
BENCHMARK(Optimize)
    ->Unit(benchmark::kMillisecond)
    ->ArgNames({"percent_false", "gate"})
    ->ArgsProduct({{0, 30, 50}, {1, 0}});

/// One more loop in a graph that is optimised already.
void AddLoop(benchmark::State& state) {
  const bool is_true = state.range(0) != 0;
  Setting setting(30);
  PoseGraphConfig config;
  config.odometry_gate_scale = 1e6;
  const std::size_t added = is_true ? kLoops - 1 : kLoops;
  const GraphEdge loop = setting.loops[added];
  setting.loops.resize(kLoops - (is_true ? 1 : 0));
  PoseGraph optimized = BuildGraph(setting.world, setting.loops, config);
  optimized.Optimize();
  PoseGraph graph = optimized;
  for (auto _ : state) {
    state.PauseTiming();
    graph = optimized;
    state.ResumeTiming();
    graph.AddEdge(loop);
    graph.Optimize();
  }
  Report(setting, graph, state);
}
BENCHMARK(AddLoop)->Unit(benchmark::kMillisecond)->ArgName("true")->Arg(1)->Arg(0);

}  // namespace
}  // namespace hv::loop

BENCHMARK_MAIN();
