#include "hv_navigation/global_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

namespace hv::navigation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

std::size_t IndexIn(int width, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(x);
}

bool IsWhole(const OccupancyGrid& grid) {
  return grid.width > 0 && grid.height > 0 && grid.resolution_m > 0.0 && grid.origin.allFinite() &&
         grid.cells.size() == IndexIn(grid.width, 0, grid.height);
}

/// Corners of the grid, seen in another frame.
std::pair<Vector2d, Vector2d> BoundsOf(const OccupancyGrid& grid, const PlanarPose& T_a_grid) {
  const Vector2d size = grid.resolution_m * Vector2d(grid.width, grid.height);
  Vector2d low = T_a_grid * grid.origin;
  Vector2d high = low;
  for (const Vector2d& corner : {Vector2d(size.x(), 0.0), Vector2d(0.0, size.y()), size}) {
    const Vector2d at = T_a_grid * Vector2d(grid.origin + corner);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  return {low, high};
}

Eigen::Isometry2d Isometry(const PlanarPose& pose) {
  return Eigen::Translation2d(pose.position) * Eigen::Isometry2d(Eigen::Rotation2Dd(pose.yaw));
}

template <typename Value>
void Move(std::vector<Value>& cells, const OccupancyGrid& from, const OccupancyGrid& to,
          Value blank) {
  const Vector2i shift = ((from.origin - to.origin) / to.resolution_m).array().round().cast<int>();
  std::vector<Value> moved(IndexIn(to.width, 0, to.height), blank);
  for (int y = 0; y < from.height; ++y) {
    std::copy_n(
        cells.begin() + static_cast<std::ptrdiff_t>(IndexIn(from.width, 0, y)), from.width,
        moved.begin() + static_cast<std::ptrdiff_t>(IndexIn(to.width, shift.x(), y + shift.y())));
  }
  cells = std::move(moved);
}

}  // namespace

GlobalGrid::GlobalGrid(const GlobalGridConfig& config, std::optional<OccupancyGrid> saved)
    : config_(config) {
  grid_.resolution_m = config.resolution_m;
  if (!saved || !IsWhole(*saved)) return;
  grid_ = std::move(*saved);
  has_saved_ = true;
  changes_.everything = true;
  saved_ = grid_.cells;
  run_.assign(saved_.size(), 0);
  FindMovable();
}

void GlobalGrid::FindMovable() {
  cv::Mat occupied(grid_.height, grid_.width, CV_8U);
  std::transform(saved_.begin(), saved_.end(), occupied.begin<std::uint8_t>(),
                 [](std::int8_t cell) { return OccupancyGrid::IsOccupied(cell) ? 255 : 0; });
  cv::Mat labels;
  cv::Mat statistics;
  cv::Mat centers;
  cv::connectedComponentsWithStats(occupied, labels, statistics, centers, 8, CV_32S);
  const double most = config_.movable_m / grid_.resolution_m;
  fixed_.assign(saved_.size(), 0);
  std::transform(labels.begin<int>(), labels.end<int>(), fixed_.begin(), [&](int label) {
    const double longest = std::max(statistics.at<int>(label, cv::CC_STAT_WIDTH),
                                    statistics.at<int>(label, cv::CC_STAT_HEIGHT));
    return static_cast<std::uint8_t>(label > 0 && longest > most + 1e-6 ? 1 : 0);
  });
  cv::Mat about;
  cv::dilate(occupied, about, cv::Mat::ones(3, 3, CV_8U));
  beside_.assign(saved_.size(), 0);
  std::transform(
      about.begin<std::uint8_t>(), about.end<std::uint8_t>(), saved_.begin(), beside_.begin(),
      [](std::uint8_t near, std::int8_t cell) {
        return static_cast<std::uint8_t>(near != 0 && !OccupancyGrid::IsOccupied(cell) ? 1 : 0);
      });
}

/// Cells to add before and behind one axis, in whole steps; none where it would become too long.
std::pair<int, int> GlobalGrid::GrowthAlong(int axis, double low_m, double high_m) const {
  const double cell_m = grid_.resolution_m;
  const int size = axis == 0 ? grid_.width : grid_.height;
  const int step = static_cast<int>(std::ceil(config_.growth_m / cell_m));
  const double most = std::max<double>(size, config_.max_side_m / cell_m);
  const auto cells = [&](double missing_m) {
    return missing_m > 0.0 ? step * std::ceil(missing_m / (cell_m * step)) : 0.0;
  };
  const double before = cells(grid_.origin[axis] - low_m);
  const double after = cells(high_m - grid_.origin[axis] - cell_m * size);
  if (size + before + after > most) return {0, 0};
  return {static_cast<int>(before), static_cast<int>(after)};
}

void GlobalGrid::GrowToHold(const Vector2d& low, const Vector2d& high) {
  if (grid_.cells.empty()) {
    grid_.width = grid_.height = 0;
    grid_.origin = (low / grid_.resolution_m).array().floor() * grid_.resolution_m;
  }
  const auto [left, right] = GrowthAlong(0, low.x(), high.x());
  const auto [below, above] = GrowthAlong(1, low.y(), high.y());
  if (left + right + below + above == 0) return;
  OccupancyGrid larger;
  larger.resolution_m = grid_.resolution_m;
  larger.origin = grid_.origin - grid_.resolution_m * Vector2d(left, below);
  larger.width = grid_.width + left + right;
  larger.height = grid_.height + below + above;
  Move(grid_.cells, grid_, larger, OccupancyGrid::kUnknown);
  Move(saved_, grid_, larger, OccupancyGrid::kUnknown);
  Move(fixed_, grid_, larger, std::uint8_t{0});
  Move(beside_, grid_, larger, std::uint8_t{0});
  Move(run_, grid_, larger, std::int8_t{0});
  larger.cells = std::move(grid_.cells);
  grid_ = std::move(larger);
  changes_.everything = true;
}

void GlobalGrid::Update(const OccupancyGrid& observed, const PlanarPose& T_map_odom,
                        const Vector2d& robot_in_odom) {
  constexpr double kFurthest_m = 1e6;
  if (!IsWhole(observed) || !robot_in_odom.allFinite() || !std::isfinite(T_map_odom.yaw)) return;
  const auto [low, high] = BoundsOf(observed, T_map_odom);
  if (!(low.array().abs() < kFurthest_m).all() || !(high.array().abs() < kFurthest_m).all()) return;
  GrowToHold(low, high);
  const Vector2d robot = T_map_odom * robot_in_odom;
  const OccupancyGrid view = Turned(observed, T_map_odom);
  const Vector2i first = grid_.CellOf(view.CenterOf({0, 0}));
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      if (view.At(x, y) == OccupancyGrid::kUnknown) continue;
      const Vector2i cell = first + Vector2i(x, y);
      if (!grid_.Contains(cell)) {
        ++left_out_;
        continue;
      }
      const bool near = (grid_.CenterOf(cell) - robot).norm() <= config_.clear_range_m;
      TakeCell(cell, OccupancyGrid::IsOccupied(view.At(x, y)), near);
    }
  }
}

/// The view in the frame of the map, its cells over those of the grid.
OccupancyGrid GlobalGrid::Turned(const OccupancyGrid& observed,
                                 const PlanarPose& T_map_odom) const {
  const auto [low, high] = BoundsOf(observed, T_map_odom);
  const Vector2i first = grid_.CellOf(low);
  const Vector2i size = grid_.CellOf(high) - first + Vector2i::Ones();
  OccupancyGrid view;
  view.resolution_m = grid_.resolution_m;
  view.origin = grid_.origin + grid_.resolution_m * first.cast<double>();
  view.width = size.x();
  view.height = size.y();
  view.cells.assign(IndexIn(size.x(), 0, size.y()), OccupancyGrid::kUnknown);
  const Eigen::Isometry2d T_map_odom_2d = Isometry(T_map_odom);
  const Eigen::Isometry2d T_odom_map = T_map_odom_2d.inverse();
  for (int y = 0; y < size.y(); ++y) {
    for (int x = 0; x < size.x(); ++x) {
      const Vector2i cell = observed.CellOf(T_odom_map * view.CenterOf({x, y}));
      if (observed.Contains(cell)) view.At(x, y) = observed.At(cell.x(), cell.y());
    }
  }
  // Sampling alone would lose obstacles as thin as a cell where the frames are turned.
  for (int y = 0; y < observed.height; ++y) {
    for (int x = 0; x < observed.width; ++x) {
      if (!OccupancyGrid::IsOccupied(observed.At(x, y))) continue;
      const Vector2i cell = view.CellOf(T_map_odom_2d * observed.CenterOf({x, y}));
      if (view.Contains(cell)) view.At(cell.x(), cell.y()) = OccupancyGrid::kOccupied;
    }
  }
  return view;
}

void GlobalGrid::TakeCell(const Vector2i& at, bool occupied, bool near) {
  const std::size_t index = IndexIn(grid_.width, at.x(), at.y());
  const bool was_saved = OccupancyGrid::IsOccupied(saved_[index]);
  if (was_saved && !occupied && !near) return;
  if (beside_[index] != 0 && occupied) return;
  const int run = run_[index];
  const int next = occupied ? std::min(config_.mark_views, std::max(0, run) + 1)
                            : std::max(-config_.clear_views, std::min(0, run) - 1);
  run_[index] = static_cast<std::int8_t>(next);
  if (next >= config_.mark_views) SetCell(at, OccupancyGrid::kOccupied);
  const bool is_free =
      next <= -config_.clear_views || (!occupied && grid_.cells[index] == OccupancyGrid::kUnknown);
  if (is_free && fixed_[index] == 0) SetCell(at, OccupancyGrid::kFree);
}

bool GlobalGrid::IsAddition(std::size_t index) const {
  return has_saved_ && OccupancyGrid::IsOccupied(grid_.cells[index]) &&
         !OccupancyGrid::IsOccupied(saved_[index]);
}

void GlobalGrid::SetCell(const Vector2i& at, std::int8_t value) {
  const std::size_t index = IndexIn(grid_.width, at.x(), at.y());
  if (grid_.cells[index] == value) return;
  additions_ -= IsAddition(index) ? 1 : 0;
  grid_.cells[index] = value;
  additions_ += IsAddition(index) ? 1 : 0;
  Include(at, changes_.cells);
}

void GlobalGrid::ForgetAdditions() {
  if (additions_ == 0) return;
  for (int y = 0; y < grid_.height; ++y) {
    for (int x = 0; x < grid_.width; ++x) {
      const std::size_t index = IndexIn(grid_.width, x, y);
      if (!IsAddition(index)) continue;
      SetCell({x, y}, saved_[index]);
      run_[index] = 0;
    }
  }
}

void GlobalGrid::ForgetViews() {
  grid_.cells = saved_;
  additions_ = 0;
  std::fill(run_.begin(), run_.end(), std::int8_t{0});
  changes_.everything = true;
}

}  // namespace hv::navigation
