#pragma once

#include <algorithm>
#include <random>
#include <string>

#include "hv_explore_sac/exploration_map.h"

namespace hv::explore {

/// Rooms of some tiles joined by corridors two tiles wide, in a solid block, as a tiles file.
inline std::string RandomTiles(unsigned seed, int columns = 24, int rows = 18, int rooms = 6) {
  std::mt19937 random(seed);
  std::vector<std::string> tiles(static_cast<std::size_t>(rows),
                                 std::string(static_cast<std::size_t>(columns), '#'));
  const auto carve = [&](int left, int top, int right, int bottom) {
    for (int y = std::max(1, top); y <= std::min(rows - 2, bottom); ++y) {
      for (int x = std::max(1, left); x <= std::min(columns - 2, right); ++x) {
        tiles[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] = '.';
      }
    }
  };
  const auto draw = [&random](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  int last_x = draw(2, columns - 4);
  int last_y = draw(2, rows - 4);
  const int start_x = last_x;
  const int start_y = last_y;
  for (int room = 0; room < rooms; ++room) {
    const int x = draw(2, columns - 4);
    const int y = draw(2, rows - 4);
    carve(x - draw(0, 3), y - draw(0, 3), x + draw(1, 3), y + draw(1, 3));
    carve(std::min(x, last_x), last_y, std::max(x, last_x) + 1, last_y + 1);
    carve(x, std::min(y, last_y), x + 1, std::max(y, last_y) + 1);
    last_x = x;
    last_y = y;
  }
  tiles[static_cast<std::size_t>(start_y)][static_cast<std::size_t>(start_x)] = 'S';
  std::string text = "map random_" + std::to_string(seed) + " " +
                     std::to_string(16 * start_x + 15) + " " + std::to_string(16 * start_y + 7) +
                     "\n";
  for (const std::string& row : tiles) text += row + "\n";
  return text;
}

inline ExplorationMap RandomMap(unsigned seed) { return ParseTiles(RandomTiles(seed), "test")[0]; }

/// A free cell of the map.
inline Eigen::Vector2i RandomFreeCell(const ExplorationMap& map, std::mt19937& random) {
  std::uniform_int_distribution<int> x(0, map.width - 1);
  std::uniform_int_distribution<int> y(0, map.height - 1);
  while (true) {
    const Eigen::Vector2i cell(x(random), y(random));
    if (map.IsFree(map.IndexOf(cell))) return cell;
  }
}

}  // namespace hv::explore
