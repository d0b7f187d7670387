#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>

#include <Eigen/Core>

#include "hv_core/trajectory.h"

namespace hv::replay {

/// Collects points of a map into columns and paints them seen from above: hue by height,
/// brightness by density, on a dark background. Memory grows with the area covered, not with the
/// number of points. Not thread-safe.
class MapPicture {
 public:
  /// `cell_m`: edge of a column.
  explicit MapPicture(double cell_m = 0.05) : cell_m_(cell_m) {}

  /// A point in the map frame [m]; points that are not finite or beyond 100 km are ignored.
  void Add(const Eigen::Vector3d& point);

  std::size_t cells() const { return columns_.size(); }

  /// Paints the map with `trajectory` on top (may be empty), interrupted where that is for more
  /// than a second. Throws InputError when there are no points or the file cannot be written.
  void Save(const Trajectory& trajectory, const std::string& title, const std::string& path) const;

 private:
  friend class MapPainter;

  struct Column {
    float count = 0.0F;
    float height_sum = 0.0F;  ///< [m]
  };

  double cell_m_;
  std::unordered_map<std::uint64_t, Column> columns_;
};

}  // namespace hv::replay
