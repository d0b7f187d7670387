#include "hv_navigation/ground_model.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hv::navigation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

constexpr double kLongestGap_m = 1.0;  // allowed for in full; longer ones like this

const std::array<Vector2i, 4> kSides = {Vector2i(1, 0), Vector2i(0, 1), Vector2i(-1, 0),
                                        Vector2i(0, -1)};

/// Ground that can be followed further.
bool Carries(Ground kind) { return kind == Ground::kAssumed || kind == Ground::kSeen; }

double MiddleOf(const SurfaceColumns::Surface& surface) {
  return 0.5 * (static_cast<double>(surface.low) + static_cast<double>(surface.high));
}

/// Top of what stands on `from` without a gap of a voxel and a half.
double TopOf(const SurfaceColumns::Column& column, const SurfaceColumns::Surface* from,
             double voxel_m) {
  double top = static_cast<double>(from->high);
  for (const auto* next = from + 1; next != column.end(); ++next) {
    if (static_cast<double>(next->low) > top + 1.5 * voxel_m) break;
    top = std::max(top, static_cast<double>(next->high));
  }
  return top;
}

}  // namespace

GroundModel::GroundModel(const SurfaceColumns& columns, const GroundConfig& config,
                         const Pose& T_odom_base)
    : columns_(columns),
      config_(config),
      steepest_(std::tan(config.max_slope_deg * M_PI / 180.0)),
      cells_(static_cast<std::size_t>(columns.side()) * static_cast<std::size_t>(columns.side())) {
  Grow(PlaceRobot(T_odom_base));
  MarkSlopes();
}

/// The floor under the robot: a plane below its base. Returns the cells that it covers.
std::vector<Vector2i> GroundModel::PlaceRobot(const Pose& T_odom_base) {
  const Eigen::Vector3d up = T_odom_base.linear().col(2);
  const Eigen::Vector3d floor = T_odom_base.translation() - config_.base_height_m * up;
  Vector2d slope = Vector2d::Zero();
  if (up.z() > 0.1) slope = -up.head<2>() / up.z();
  if (slope.norm() > steepest_) slope *= steepest_ / slope.norm();
  for (Cell& cell : cells_) cell.height = cell.reference = floor.z();
  std::vector<Vector2i> covered;
  const double voxel_m = columns_.voxel_m();
  const int radius = static_cast<int>(std::ceil(config_.seed_radius_m / voxel_m));
  const Vector2i middle = Vector2i::Constant(columns_.side() / 2);
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      const Vector2i at = middle + Vector2i(x, y);
      const Vector2d center =
          columns_.origin() + voxel_m * (at.cast<double>() + Vector2d::Constant(0.5));
      const Vector2d away = center - floor.head<2>();
      if (!columns_.Contains(at) || away.norm() > config_.seed_radius_m + 0.5 * voxel_m) continue;
      Cell& cell = cells_[columns_.Index(at)];
      cell.kind = Ground::kSeen;
      cell.stood_upon = true;
      cell.slope = slope;
      cell.height = cell.reference = floor.z() + slope.dot(away);
      covered.push_back(at);
    }
  }
  return covered;
}

/// Breadth first, so that each cell is reached on a shortest way.
void GroundModel::Grow(std::vector<Vector2i> front) {
  for (std::size_t i = 0; i < front.size(); ++i) {
    for (const Vector2i& side : kSides) {
      const Vector2i next = front[i] + side;
      if (!columns_.Contains(next)) continue;
      if (cells_[columns_.Index(next)].kind != Ground::kUnknown) continue;
      if (Visit(next)) front.push_back(next);
    }
  }
  for (Cell& cell : cells_) {
    if (cell.kind == Ground::kUnknown && cell.pending) cell.kind = Ground::kStep;
  }
}

/// The nearer the ground was seen, the more a cell around counts.
GroundModel::Expected GroundModel::ExpectedAt(const Vector2i& cell) const {
  Expected expected;
  const double voxel_m = columns_.voxel_m();
  double sum = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      const Vector2i near = cell + Vector2i(x, y);
      if (!columns_.Contains(near)) continue;
      const Cell& known = cells_[columns_.Index(near)];
      if (!Carries(known.kind)) continue;
      const Vector2d way = -voxel_m * Vector2d(x, y);
      const double distance_m = known.unseen_m + voxel_m;
      const double weight = 1.0 / (distance_m * distance_m);
      expected.height += weight * (known.height + known.slope.dot(way));
      expected.slope += weight * known.slope;
      expected.way += weight * way;
      expected.unseen_m = std::min(expected.unseen_m, known.unseen_m + way.norm());
      sum += weight;
    }
  }
  expected.height /= sum;
  expected.slope /= sum;
  expected.way /= sum;
  expected.gap_m = std::max(0.0, std::min(kLongestGap_m, expected.unseen_m - 1.5 * voxel_m));
  return expected;
}

/// Whether the ground can be followed over the cell.
bool GroundModel::Visit(const Vector2i& at) {
  constexpr double kFlattening_m = 1.0;  // what is not seen is more likely level
  constexpr double kHighestStep_m = 0.5;
  const std::size_t index = columns_.Index(at);
  const Expected expected = ExpectedAt(at);
  const double allowed_m = config_.max_step_m + steepest_ * expected.gap_m;
  const SurfaceColumns::Column column = columns_.At(index);
  Cell& cell = cells_[index];
  if (TakeSurface(column, expected, allowed_m, cell)) return true;
  if (!cell.pending) cell.height = cell.reference = expected.height;
  const double below = expected.height - allowed_m;
  const bool drops = std::any_of(column.begin(), column.end(),
                                 [&](const auto& surface) { return MiddleOf(surface) < below; });
  if (drops || columns_.FreeBelow(index, below)) {
    cell.kind = Ground::kDrop;
    return false;
  }
  cell.pending = column.begin() != column.end() &&
                 MiddleOf(*column.begin()) < expected.height + kHighestStep_m;
  if (cell.pending) return false;
  cell.kind = Ground::kAssumed;
  cell.slope = std::max(0.0, 1.0 - columns_.voxel_m() / kFlattening_m) * expected.slope;
  cell.unseen_m = expected.unseen_m;
  return true;
}

/// The lowest surface about where the ground leads, unless it is the foot of something higher.
bool GroundModel::TakeSurface(const SurfaceColumns::Column& column, const Expected& expected,
                              double allowed_m, Cell& cell) const {
  constexpr double kGain = 0.3;
  const auto* found = std::find_if(column.begin(), column.end(), [&](const auto& surface) {
    return std::abs(MiddleOf(surface) - expected.height) <= allowed_m;
  });
  if (found == column.end()) return false;
  const double height = MiddleOf(*found);
  const double lowest = expected.gap_m > 0.0 ? height : std::min(height, expected.height);
  if (TopOf(column, found, columns_.voxel_m()) > lowest + allowed_m) return false;
  const double run = expected.gap_m + columns_.voxel_m();
  const double change = kGain * (height - expected.height) / run;
  cell.slope = expected.slope;
  if (expected.way.norm() > 0.0) cell.slope += change * expected.way.normalized();
  if (cell.slope.norm() > steepest_) cell.slope *= steepest_ / cell.slope.norm();
  cell.kind = Ground::kSeen;
  cell.height = height;
  cell.reference = lowest;
  cell.unseen_m = 0.0;
  return true;
}

/// Compares seen ground over a distance, where the height of a step no longer counts for much. The
/// floor under the robot is no slope, whatever was taken for ground beside it.
void GroundModel::MarkSlopes() {
  std::vector<std::size_t> steep;
  for (int y = 0; y < columns_.side(); ++y) {
    for (int x = 0; x < columns_.side(); ++x) {
      const Vector2i cell(x, y);
      const Cell& ground = cells_[columns_.Index(cell)];
      if (ground.kind != Ground::kSeen || ground.stood_upon) continue;
      const bool any = std::any_of(kSides.begin(), kSides.end(),
                                   [&](const Vector2i& side) { return IsSteep(cell, side); });
      if (any) steep.push_back(columns_.Index(cell));
    }
  }
  for (const std::size_t index : steep) cells_[index].kind = Ground::kSlope;
}

bool GroundModel::IsSteep(const Vector2i& cell, const Vector2i& step) const {
  constexpr double kNearest_m = 0.3;
  constexpr double kFurthest_m = 0.8;
  const double voxel_m = columns_.voxel_m();
  const auto first = static_cast<int>(std::ceil(kNearest_m / voxel_m - 1e-6));
  const auto last = static_cast<int>(std::floor(kFurthest_m / voxel_m));
  for (int i = first; i <= last; ++i) {
    const Vector2i other = cell + i * step;
    if (!columns_.Contains(other)) return false;
    const Cell& far = cells_[columns_.Index(other)];
    if (far.kind != Ground::kSeen) continue;
    const double rise = std::abs(far.height - cells_[columns_.Index(cell)].height);
    return rise > std::max(config_.max_step_m, steepest_ * i * voxel_m);
  }
  return false;
}

}  // namespace hv::navigation
