#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace hv::explore {

/// A true map to explore in simulation.
struct ExplorationMap {
  std::string name;
  std::string unit = "px";                           ///< of lengths in results
  double cell_size = 1.0;                            ///< edge of a cell [unit]
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< centre of cell (0, 0) [unit]
  int width = 0;
  int height = 0;
  std::vector<char> free;  ///< of each cell, rows of growing y, x fastest
  Eigen::Vector2i start = Eigen::Vector2i::Zero();

  int IndexOf(const Eigen::Vector2i& cell) const { return cell.y() * width + cell.x(); }
  bool IsFree(int index) const { return free[static_cast<std::size_t>(index)] != 0; }
  bool Contains(const Eigen::Vector2i& cell) const {
    return cell.x() >= 0 && cell.y() >= 0 && cell.x() < width && cell.y() < height;
  }
  int CountFree() const;
};

/// Cells along the edge of a tile of a tiles text file.
inline constexpr int kTileCells = 16;

/// Reads all maps of a tiles text file (blocks of a head line "map NAME START_X START_Y ..." and
/// rows of dots and S for what is free, # for what is not, 16 cells wide each), of a folder of PNG
/// or PGM images (of the public dungeon benchmark: bright is free, the start is marked by grey
/// 208), or the one of a map_server YAML file. Throws InputError naming the file, the place and
/// what is wrong.
std::vector<ExplorationMap> ReadExplorationMaps(const std::string& path);

/// The same from the text of a tiles file; `source` names it in messages.
std::vector<ExplorationMap> ParseTiles(const std::string& text, const std::string& source);

/// One image. Throws InputError.
ExplorationMap ReadImageMap(const std::string& path);

/// A map_server map: free where it is known to be free and connected with the start, which is the
/// place farthest from obstacles. Throws InputError.
ExplorationMap ReadGridMap(const std::string& yaml_path);

}  // namespace hv::explore
