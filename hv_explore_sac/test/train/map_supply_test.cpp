#include "hv_explore_sac/train/map_supply.h"

#include <set>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "random_maps.h"

namespace hv::explore {
namespace {

class MapSupplyTest : public testing::Test {
 protected:
  MapSupplyTest() {
    for (unsigned seed = 1; seed <= 6; ++seed) maps_.push_back(RandomMap(seed));
    for (const ExplorationMap& map : maps_) parents_.push_back(&map);
  }

  std::vector<ExplorationMap> maps_;
  std::vector<const ExplorationMap*> parents_;
};

/// Whether the cell is free in the map, in one of its four mirrors.
bool IsFreeIn(const ExplorationMap& map, int x, int y, int mirror) {
  if ((mirror & 1) != 0) x = map.width - 1 - x;
  if ((mirror & 2) != 0) y = map.height - 1 - y;
  return map.IsFree(map.IndexOf({x, y}));
}

/// Whether the free cells of `map` with a < 16 k are free in a mirror of one of `parents`, and
/// those with a >= 16 k in that of another one, a being x or y.
bool IsCross(const ExplorationMap& map, const std::vector<ExplorationMap>& parents, bool columns,
             int k) {
  int halves = 0;
  for (const bool first : {true, false}) {
    bool found = false;
    for (std::size_t i = 0; i < 4 * parents.size() && !found; ++i) {
      bool fits = true;
      for (int y = 0; y < map.height && fits; ++y) {
        for (int x = 0; x < map.width && fits; ++x) {
          if (((columns ? x : y) < 16 * k) != first || !map.IsFree(map.IndexOf({x, y}))) continue;
          fits = IsFreeIn(parents[i / 4], x, y, static_cast<int>(i % 4));
        }
      }
      found = fits;
    }
    halves += found ? 1 : 0;
  }
  return halves == 2;
}

TEST_F(MapSupplyTest, CrossesAreMadeOfTwoMaps) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const ExplorationMap map = CrossedMap(parents_, seed);
    bool cross = false;
    for (int k = 1; k < 24 && !cross; ++k) {
      cross = IsCross(map, maps_, true, k) || IsCross(map, maps_, false, k);
    }
    EXPECT_TRUE(cross) << map.name;
    for (const ExplorationMap& parent : maps_) EXPECT_NE(map.free, parent.free);
  }
}

TEST_F(MapSupplyTest, AllOfACrossCanBeReached) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const ExplorationMap map = CrossedMap(parents_, seed);
    ASSERT_TRUE(map.Contains(map.start));
    std::set<int> reached;
    std::vector<int> open{map.IndexOf(map.start)};
    while (!open.empty()) {
      const int index = open.back();
      open.pop_back();
      if (!map.IsFree(index) || !reached.insert(index).second) continue;
      for (const int step : {1, -1, map.width, -map.width}) open.push_back(index + step);
    }
    EXPECT_EQ(static_cast<int>(reached.size()), map.CountFree());
  }
}

TEST_F(MapSupplyTest, GivesTheMapsAndThenAsManyCrosses) {
  MapSupply supply({&maps_[0], &maps_[1]});
  EXPECT_EQ(supply.size(), 2U);
  supply.AddCrossed(parents_, 3, 7);
  ASSERT_EQ(supply.size(), 5U);
  EXPECT_EQ(supply.Map(1).free, maps_[1].free);
  EXPECT_EQ(supply.Map(2).free, CrossedMap(parents_, 7).free);
  EXPECT_EQ(supply.Map(4).free, CrossedMap(parents_, 9).free);
  EXPECT_NE(supply.Map(3).free, supply.Map(4).free);
}

TEST_F(MapSupplyTest, EachMapHasItsTurn) {
  EXPECT_EQ(InTurn(parents_, 0, 4), std::vector(parents_.begin(), parents_.begin() + 4));
  EXPECT_EQ(InTurn(parents_, 4, 3), (std::vector{parents_[4], parents_[5], parents_[0]}));
  EXPECT_EQ(InTurn(parents_, 12, 4), InTurn(parents_, 0, 4));
  EXPECT_EQ(InTurn({parents_[1]}, 5, 2), (std::vector{parents_[1], parents_[1]}));
}

TEST_F(MapSupplyTest, MapsThatDoNotGoTogetherAreSaid) {
  ExplorationMap other = ParseTiles(RandomTiles(9, 30, 18), "test")[0];
  EXPECT_THROW(CrossedMap({&maps_[0], &other}, 1), InputError);
  EXPECT_THROW(CrossedMap({&maps_[0]}, 1), InputError);
  EXPECT_THROW(CrossedMap({}, 1), InputError);
}

}  // namespace
}  // namespace hv::explore
