#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace hv {

/// A 2-D map of cells, as nav_msgs/OccupancyGrid holds it.
struct OccupancyGrid {
  static constexpr std::int8_t kUnknown = -1;
  static constexpr std::int8_t kFree = 0;
  static constexpr std::int8_t kOccupied = 100;

  double resolution_m = 0.1;                         ///< edge of a cell
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower left corner of cell (0, 0) [m]
  int width = 0;                                     ///< cells along x
  int height = 0;                                    ///< cells along y
  std::vector<std::int8_t> cells;                    ///< rows of growing y, x fastest

  /// Whether a cell is known to be occupied.
  static bool IsOccupied(std::int8_t cell) { return cell >= kOccupied / 2; }

  /// The cell that holds `position`, which may lie outside; far outside for one that is nowhere.
  Eigen::Vector2i CellOf(const Eigen::Vector2d& position) const {
    constexpr double kFarthest = 1e8;
    const Eigen::Array2d cell = ((position - origin) / resolution_m).array().floor();
    return cell.max(-kFarthest).min(kFarthest).cast<int>();
  }
  Eigen::Vector2d CenterOf(const Eigen::Vector2i& cell) const {
    return origin + resolution_m * (cell.cast<double>() + Eigen::Vector2d::Constant(0.5));
  }
  bool Contains(const Eigen::Vector2i& cell) const {
    return cell.x() >= 0 && cell.y() >= 0 && cell.x() < width && cell.y() < height;
  }

  std::int8_t& At(int column, int row) { return cells[Index(column, row)]; }
  std::int8_t At(int column, int row) const { return cells[Index(column, row)]; }

 private:
  std::size_t Index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
};

/// Writes `<folder>/<name>.pgm` and `<folder>/<name>.yaml` as map_server reads them. Throws
/// InputError when they cannot be written.
void WriteGrid(const std::string& folder, const std::string& name, const OccupancyGrid& grid);

/// Reads a map_server YAML file and the 8-bit PGM (P5 or P2) it names. Origins with a rotation are
/// refused. Throws InputError naming the file and what is wrong.
OccupancyGrid ReadGrid(const std::string& yaml_path);

/// The same from both files in memory; the sources name them in messages.
OccupancyGrid ParseGrid(const std::string& yaml, const std::string& yaml_source,
                        std::string_view pgm, const std::string& pgm_source);

}  // namespace hv
