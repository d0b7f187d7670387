#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace hv::explore {

/// A polygon in the map, or everything.
class Bounds {
 public:
  /// Everything.
  Bounds() = default;
  /// `corners` in order, either way round [m]; none: everything.
  explicit Bounds(std::vector<Eigen::Vector2d> corners) : corners_(std::move(corners)) {}

  bool everything() const { return corners_.empty(); }
  bool Contains(const Eigen::Vector2d& position) const;

  /// What is wrong with the polygon in one line; empty when nothing is.
  std::string Problem() const;

 private:
  bool CrossesItself() const;

  std::vector<Eigen::Vector2d> corners_;
};

}  // namespace hv::explore
