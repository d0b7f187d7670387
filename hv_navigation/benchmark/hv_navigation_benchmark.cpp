#include <cmath>
#include <random>

#include <benchmark/benchmark.h>

#include "hv_navigation/global_planner.h"
#include "hv_navigation/local_planner.h"

namespace hv::navigation {
namespace {

constexpr double kRoom_m = 5.0;
constexpr double kCorridor_m = 2.5;
constexpr double kDoor_m = 0.9;

/// A floor of rooms in double rows between corridors, each with a door and some furniture.
OccupancyGrid Office(int cells, double resolution_m) {
  OccupancyGrid grid;
  grid.resolution_m = resolution_m;
  grid.width = grid.height = cells;
  grid.cells.assign(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells),
                    OccupancyGrid::kFree);
  const double rows_m = 2.0 * kRoom_m + kCorridor_m;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform;
  for (int y = 0; y < cells; ++y) {
    for (int x = 0; x < cells; ++x) {
      const double across_m = std::fmod(resolution_m * y, rows_m) - kCorridor_m;
      const double along_m = std::fmod(resolution_m * x, kRoom_m);
      const bool room = across_m > 0.0;
      const bool crossing = std::fmod(resolution_m * x, 8.0 * kRoom_m) < kCorridor_m;
      const bool border = x == 0 || y == 0 || x + 1 == cells || y + 1 == cells;
      const bool edge = across_m < 0.15 || across_m > 2.0 * kRoom_m - 0.15;
      const bool door = edge && std::abs(along_m - 2.5) < 0.5 * kDoor_m;
      const bool wall = edge || along_m < 0.15 || std::abs(across_m - kRoom_m) < 0.08;
      if (border || (room && !crossing && wall && !door)) grid.At(x, y) = OccupancyGrid::kOccupied;
    }
  }
  const double size_m = cells * resolution_m;
  for (int i = 0; i < static_cast<int>(size_m * size_m / 20.0); ++i) {
    const int left = static_cast<int>(uniform(random) * (cells - 12));
    const int low = static_cast<int>(uniform(random) * (cells - 12));
    for (int y = low; y < low + 8; ++y) {
      for (int x = left; x < left + 12; ++x) grid.At(x, y) = OccupancyGrid::kOccupied;
    }
  }
  return grid;
}

PlanarPose RandomPose(const ClearanceGrid& grid, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform;
  const OccupancyGrid& cells = grid.grid();
  while (true) {
    const PlanarPose pose{cells.resolution_m * Eigen::Vector2d(uniform(random) * cells.width,
                                                               uniform(random) * cells.height),
                          2.0 * M_PI * uniform(random)};
    if (grid.ClearanceAt(pose.position) > 0.55) return pose;
  }
}

/// Argument: cells of an edge, at 0.05 m.
void PlanGlobally(benchmark::State& state) {
  const ClearanceGrid grid(Office(static_cast<int>(state.range(0)), 0.05),
                           ClearanceGrid::Unknown::kOccupied, 1.5);
  const GlobalPlanner planner({}, Footprint());
  std::mt19937 random(1);
  double length_m = 0.0;
  double detour = 0.0;
  double found = 0.0;
  for (auto _ : state) {
    PlanRequest request;
    request.start = RandomPose(grid, random);
    request.goal = RandomPose(grid, random);
    const auto plan = planner.Plan(grid, request);
    if (!plan.Found()) continue;
    found += 1.0;
    length_m += plan.length_m;
    detour += plan.length_m / plan.grid_length_m;
  }
  state.counters["found"] = found / static_cast<double>(state.iterations());
  state.counters["length_m"] = length_m / found;
  state.counters["detour"] = detour / found;
}
BENCHMARK(PlanGlobally)->Arg(800)->Arg(2000)->Unit(benchmark::kMillisecond)->Iterations(60);

/// A cycle in a window of 10 x 10 m of that office.
void FollowLocally(benchmark::State& state) {
  const ClearanceGrid grid(Office(800, 0.05), ClearanceGrid::Unknown::kOccupied, 1.5);
  const GlobalPlanner planner({}, Footprint());
  std::mt19937 random(1);
  PlanRequest request;
  request.start = RandomPose(grid, random);
  GlobalPlan plan;
  while (!plan.Found() || plan.length_m < 20.0) {
    request.goal = RandomPose(grid, random);
    plan = planner.Plan(grid, request);
  }
  LocalPlanner local({}, {}, Footprint());
  std::size_t at = 0;
  local.SetPath(plan.path);
  for (auto _ : state) {
    if (++at == plan.path.size()) {
      at = 0;
      local.SetPath(plan.path);
    }
    benchmark::DoNotOptimize(local.Plan(grid, plan.path[at], {0.5, 0.0}));
  }
}
BENCHMARK(FollowLocally)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hv::navigation

BENCHMARK_MAIN();
