#include <memory>

#include <benchmark/benchmark.h>

#include "hv_loop_btc/btc_database.h"
#include "hv_loop_btc/btc_descriptor.h"
#include "town.h"

namespace hv::loop {
namespace {

constexpr std::uint32_t kPlacesPerTown = 8;
constexpr int kQueries = 32;
constexpr double kVertexTolerance_m = 0.5;
constexpr std::size_t kEntries = 40;

Submap Place(int number, std::mt19937& random) {
  const Town town(static_cast<unsigned>(number) / kPlacesPerTown);
  std::uniform_real_distribution<double> place(-6.0, 6.0);
  std::uniform_real_distribution<double> heading(-M_PI, M_PI);
  const double x = place(random);
  const double y = place(random);
  return town.SubmapAt(static_cast<std::uint32_t>(number), SensorPose(x, y, heading(random)),
                       random);
}

/// A database of many places, and places to ask for that are seen again from nearby.
struct Map {
  explicit Map(int submaps) : database(config), extractor(config) {
    config.scale = "indoor";
    extractor.SetScale("indoor");
    std::mt19937 random(1);
    for (int i = 0; i < submaps; ++i) database.Add(extractor.Extract(Place(i, random)));
    for (int i = 0; i < kQueries; ++i) queries.push_back(Place(i * submaps / kQueries, random));
  }

  BtcConfig config;
  BtcDatabase database;
  BtcExtractor extractor;
  std::vector<Submap> queries;
};

void Extract(benchmark::State& state) {
  std::mt19937 random(1);
  const Submap submap = Place(0, random);
  BtcConfig config;
  config.scale = "indoor";
  BtcExtractor extractor(config);
  for (auto _ : state) benchmark::DoNotOptimize(extractor.Extract(submap).keypoints.size());
}
BENCHMARK(Extract)->Unit(benchmark::kMillisecond);

/// Extraction and query of a submap without any help of odometry: every stored place is asked.
void Detect(benchmark::State& state) {
  static std::unique_ptr<Map> map;
  const auto submaps = static_cast<std::size_t>(state.range(0));
  if (!map || map->database.size() != submaps) map = std::make_unique<Map>(state.range(0));
  const BtcDatabase::Filter all{[](std::size_t) { return true; },
                                [](std::size_t, const Pose&) { return true; }};
  std::size_t asked = 0;
  double found = 0.0;
  for (auto _ : state) {
    const Submap& submap = map->queries[asked++ % map->queries.size()];
    const BtcDescriptor descriptor = map->extractor.Extract(submap);
    const auto candidates = map->database.Query(descriptor, kVertexTolerance_m, kEntries, all);
    const bool right = !candidates.empty() && candidates.front().entry / kPlacesPerTown ==
                                                  submap.keyframe / kPlacesPerTown;
    found += right ? 1.0 : 0.0;
  }
  state.counters["found"] = found / static_cast<double>(asked);
  state.counters["kilobytes_per_submap"] =
      static_cast<double>(map->database.MemoryBytes()) / 1024.0 / static_cast<double>(submaps);
}
BENCHMARK(Detect)->Unit(benchmark::kMillisecond)->ArgName("submaps")->Arg(400)->Arg(2000);

}  // namespace
}  // namespace hv::loop

BENCHMARK_MAIN();
