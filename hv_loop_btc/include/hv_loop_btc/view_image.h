#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "hv_core/se3.h"

namespace hv::loop {

/// What is seen from the origin of a submap: the nearest surface in every direction. Two submaps of
/// one place must not see through each other's surfaces, which a wall that merely looks alike,
/// moved along a corridor, cannot help doing where a door or a junction opens.
class ViewImage {
 public:
  /// Points of a submap, in its frame [m].
  explicit ViewImage(const std::vector<Eigen::Vector3f>& points);

  struct Comparison {
    std::size_t compared = 0;      ///< points in directions in which the view is known
    std::size_t seen_through = 0;  ///< of these, those that the view passes through
  };

  /// Compares the points, moved into the frame of the view.
  Comparison Compare(const std::vector<Eigen::Vector3f>& points, const Pose& T_view_points) const;

 private:
  std::size_t Cell(int row, int column) const;
  /// Least range around a cell [m]; 0 where nothing is known.
  float NearestAround(int row, int column) const;

  std::vector<float> ranges_;   ///< nearest in each cell [m], 0 for none
  std::vector<float> nearest_;  ///< nearest in each cell and its neighbours
};

}  // namespace hv::loop
