#include "hv_explore_sac/ray_sensor.h"

#include <cmath>

#include <gtest/gtest.h>

#include "hv_explore_sac/grid_line.h"
#include "hv_explore_sac/sight_memory.h"
#include "random_maps.h"

namespace hv::explore {
namespace {

/// One ray after the other, as the benchmark describes it.
std::vector<char> SeenByBruteForce(const ExplorationMap& map, const Eigen::Vector2i& from,
                                   const SimulationConfig& config) {
  std::vector<char> seen(map.free.size(), 0);
  for (int ray = 0; ray < config.rays; ++ray) {
    const double angle = 2.0 * M_PI * ray / config.rays;
    const Eigen::Vector2i end =
        from + Eigen::Vector2i(static_cast<int>(std::lround(config.range * std::cos(angle))),
                               static_cast<int>(std::lround(config.range * std::sin(angle))));
    int depth = 0;
    WalkLine(from, end, [&](int x, int y) {
      if (!map.Contains({x, y})) return false;
      const int index = map.IndexOf({x, y});
      if (map.IsFree(index) ? depth > 0 : ++depth > config.wall_depth) return false;
      seen[static_cast<std::size_t>(index)] = 1;
      return true;
    });
  }
  return seen;
}

class Sensing : public testing::TestWithParam<unsigned> {};

TEST_P(Sensing, EqualsBruteForce) {
  const SimulationConfig config;
  const RaySensor sensor(config);
  const ExplorationMap map = RandomMap(GetParam());
  std::mt19937 random(GetParam());
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector2i from = RandomFreeCell(map, random);
    Belief belief(map.width, map.height);
    sensor.Sense(map, from, belief);
    const std::vector<char> seen = SeenByBruteForce(map, from, config);
    for (int cell = 0; cell < map.width * map.height; ++cell) {
      const Cell truth = map.IsFree(cell) ? Cell::kFree : Cell::kOccupied;
      const Cell expected = seen[static_cast<std::size_t>(cell)] != 0 ? truth : Cell::kUnknown;
      ASSERT_EQ(belief.At(cell), expected) << cell;
    }
  }
}

TEST_P(Sensing, FromMemoryIsTheSame) {
  const RaySensor sensor{SimulationConfig()};
  const ExplorationMap map = RandomMap(GetParam());
  SightMemory memory(sensor, map);
  std::mt19937 random(GetParam());
  const Eigen::Vector2i from = RandomFreeCell(map, random);
  Belief sensed(map.width, map.height);
  sensor.Sense(map, from, sensed);
  for (int time = 0; time < 2; ++time) {
    Belief remembered(map.width, map.height);
    memory.Sense(from, remembered);
    ASSERT_EQ(remembered.changes().size(), sensed.changes().size());
    for (std::size_t i = 0; i < sensed.changes().size(); ++i) {
      EXPECT_EQ(remembered.changes()[i].index, sensed.changes()[i].index);
      EXPECT_EQ(remembered.changes()[i].after, sensed.changes()[i].after);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, Sensing, testing::Range(1U, 7U));

TEST(RaySensorTest, SeesNineCellsIntoAWall) {
  const ExplorationMap map = ParseTiles("map wall 8 8\nS#\n", "test")[0];
  Belief belief(map.width, map.height);
  RaySensor(SimulationConfig()).Sense(map, map.start, belief);
  EXPECT_EQ(belief.At(Eigen::Vector2i(24, 8)), Cell::kOccupied);
  EXPECT_EQ(belief.At(Eigen::Vector2i(25, 8)), Cell::kUnknown);
}

}  // namespace
}  // namespace hv::explore
