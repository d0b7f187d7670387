#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "hv_core/se3.h"
#include "hv_navigation/mapping_config.h"
#include "hv_navigation/surface_columns.h"

namespace hv::navigation {

/// What the ground of a column is.
enum class Ground : std::uint8_t {
  kUnknown,  ///< cannot be followed to
  kAssumed,  ///< not seen, at the height that the ground around leads to
  kSeen,     ///< seen, or stood upon
  kStep,     ///< something stands there that is too high to drive over
  kSlope,    ///< seen, and too steep to drive on
  kDrop      ///< seen to lie lower than the robot can drive down
};

/// The ground around the robot, followed outwards from under it, where its pose tells the floor.
/// Heights and slopes are carried from column to column, so that ramps are followed, and steps
/// show as a difference to where the ground leads. Across a gap where nothing is seen the steepest
/// slope that the robot can drive on is allowed for. Immutable.
class GroundModel {
 public:
  /// `T_odom_base`: x forward, z up, finite, in the middle of the columns.
  GroundModel(const SurfaceColumns& columns, const GroundConfig& config, const Pose& T_odom_base);

  Ground KindAt(std::size_t index) const { return cells_[index].kind; }
  /// Height of the ground [m]; under the robot's own floor where it is unknown.
  double HeightAt(std::size_t index) const { return cells_[index].height; }
  /// Anything higher than a step above this obstructs [m].
  double ReferenceAt(std::size_t index) const { return cells_[index].reference; }

 private:
  struct Cell {
    Ground kind = Ground::kUnknown;
    bool stood_upon = false;  ///< by the robot, now
    bool pending = false;     ///< a step from one side; another side may lead onto it
    double height = 0.0;
    double reference = 0.0;
    double unseen_m = 0.0;                            ///< way from where ground was seen
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< along x and y
  };
  /// What the cells around lead to.
  struct Expected {
    double height = 0.0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    Eigen::Vector2d way = Eigen::Vector2d::Zero();  ///< from the middle of these cells [m]
    double gap_m = 0.0;                             ///< beyond the next cell, since ground was seen
    double unseen_m = std::numeric_limits<double>::infinity();
  };

  std::vector<Eigen::Vector2i> PlaceRobot(const Pose& T_odom_base);
  void Grow(std::vector<Eigen::Vector2i> front);
  Expected ExpectedAt(const Eigen::Vector2i& cell) const;
  bool Visit(const Eigen::Vector2i& cell);
  bool TakeSurface(const SurfaceColumns::Column& column, const Expected& expected, double allowed_m,
                   Cell& cell) const;
  void MarkSlopes();
  bool IsSteep(const Eigen::Vector2i& cell, const Eigen::Vector2i& step) const;

  const SurfaceColumns& columns_;
  const GroundConfig config_;
  const double steepest_;  ///< as rise by run
  std::vector<Cell> cells_;
};

}  // namespace hv::navigation
