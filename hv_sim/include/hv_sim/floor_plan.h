#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "hv_sim/world.h"

namespace hv::sim {

enum class Cell : std::uint8_t { kFree, kOccupied, kUnknown };

/// A map_server grid; row 0 is the southernmost.
struct FloorPlan {
  std::string path;  ///< of the YAML file, for messages
  int width = 0;
  int height = 0;
  double resolution = 0.05;                          ///< edge of a cell [m]
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< south-western corner [m]
  std::vector<Cell> cells;

  Cell At(int column, int row) const;
  Eigen::Vector2d Center(int column, int row) const;
};

/// Reads a map_server YAML and the PGM (P2 or P5, 8 bit) beside it. Throws InputError naming file
/// and fault.
FloorPlan ReadFloorPlan(const std::string& yaml_path);

/// Cells with column in [column, column + width) and row in [row, row + height).
struct CellBlock {
  int column = 0;
  int row = 0;
  int width = 1;
  int height = 1;
};

/// Disjoint blocks that cover exactly the occupied cells, greedily large.
std::vector<CellBlock> MergeOccupied(const FloorPlan& plan);

/// The plan with unknown cells that touch free ones made occupied: maps made by robots often show
/// walls only as the edge of what was seen.
FloorPlan CloseBorders(FloorPlan plan);

/// An open route that keeps 0.6 m from everything but free cells, or 0.45 m or 0.15 m where that
/// reaches much further. It passes through far places in turn and never turns back on the spot.
/// Throws InputError when there is none of 5 m.
std::vector<Eigen::Vector3d> PlanRoute(const FloorPlan& plan, std::uint32_t seed);

/// Walls of 2.7 m on every occupied cell of CloseBorders(plan), floor, ceiling and a route.
World ExtrudeFloorPlan(const FloorPlan& plan, std::uint32_t seed);

}  // namespace hv::sim
