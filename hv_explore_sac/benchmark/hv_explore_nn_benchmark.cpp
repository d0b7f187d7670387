#include <benchmark/benchmark.h>

#include "hv_explore_sac/nn/network.h"
#include "hv_explore_sac/nn/sac.h"
#include "sample_graphs.h"

namespace hv::explore::nn {
namespace {

constexpr int kFeatures = 10;
constexpr Index kNeighbours = 19;
constexpr Index kHistory = 32;

GraphInput GraphOf(Index nodes) {
  return RandomGraph(1, nodes, kFeatures, std::min(kNeighbours, nodes - 1), kHistory);
}

/// What a decision takes: the sample from the graph, the actor forward, the distribution.
void Decide(benchmark::State& state) {
  const Network<float> actor({}, {kFeatures, 0, 1});
  const Eigen::VectorXf parameters = actor.layout().Initial(1);
  const GraphInput graph = GraphOf(state.range(0));
  Network<float>::Workspace workspace;
  for (auto _ : state) {
    const GraphSample sample = BuildSample(graph, actor.config().pyramid_levels);
    benchmark::DoNotOptimize(ToDistribution(actor.Forward(parameters.data(), sample, workspace)));
  }
  state.SetLabel(KernelSet());
}
BENCHMARK(Decide)->Arg(100)->Arg(200)->Arg(300)->Unit(benchmark::kMillisecond);

void ForwardBackward(benchmark::State& state) {
  NetworkConfig config;
  config.encoder_layers = static_cast<int>(state.range(1));
  const Network<float> network(config, {kFeatures, 0, 1});
  const Eigen::VectorXf parameters = network.layout().Initial(1);
  Eigen::VectorXf gradient = Eigen::VectorXf::Zero(parameters.size());
  const GraphSample sample = BuildSample(GraphOf(state.range(0)), config.pyramid_levels);
  Network<float>::Workspace workspace;
  for (auto _ : state) {
    const View<float> scores = network.Forward(parameters.data(), sample, workspace);
    network.Backward(parameters.data(), scores, workspace, gradient.data());
  }
}
BENCHMARK(ForwardBackward)
    ->ArgNames({"nodes", "layers"})
    ->Args({100, 6})
    ->Args({200, 6})
    ->Args({300, 6})
    ->Args({300, 4})
    ->Unit(benchmark::kMillisecond);

/// One update of actor and critics on a batch of 32, with all threads.
void SacUpdate(benchmark::State& state) {
  Sac sac({}, {kFeatures, 0, 1}, 3);
  Transition transition;
  transition.state = BuildSample(GraphOf(state.range(0)), 2);
  transition.next = transition.state;
  for (auto _ : state) sac.Update(32, [&](std::size_t) { return transition; });
}
BENCHMARK(SacUpdate)->Arg(200)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace hv::explore::nn

BENCHMARK_MAIN();
