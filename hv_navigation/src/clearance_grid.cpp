#include "hv_navigation/clearance_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace hv::navigation {
namespace {

constexpr int kOccupiedFrom = 50;  // percent, as in nav_msgs/OccupancyGrid

bool IsObstacle(std::int8_t cell, ClearanceGrid::Unknown unknown) {
  return cell < 0 ? unknown == ClearanceGrid::Unknown::kOccupied : cell >= kOccupiedFrom;
}

}  // namespace

ClearanceGrid::ClearanceGrid(OccupancyGrid grid, Unknown unknown, double limit_m)
    : grid_(std::move(grid)),
      outside_m_(unknown == Unknown::kOccupied ? 0.0 : limit_m),
      clearance_m_(grid_.cells.size(), static_cast<float>(limit_m)) {
  if (grid_.cells.empty()) return;
  cv::Mat free(grid_.height, grid_.width, CV_8U);
  std::transform(grid_.cells.begin(), grid_.cells.end(), free.begin<std::uint8_t>(),
                 [unknown](std::int8_t cell) { return IsObstacle(cell, unknown) ? 0 : 255; });
  if (cv::countNonZero(free) == static_cast<int>(grid_.cells.size())) return;
  cv::Mat distances;
  cv::distanceTransform(free, distances, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  const auto cell_m = static_cast<float>(grid_.resolution_m);
  const auto limit = static_cast<float>(limit_m);
  std::transform(distances.begin<float>(), distances.end<float>(), clearance_m_.begin(),
                 [&](float cells) {
                   // From the border of the obstacle, not the centre of its cell.
                   return std::min(limit, cell_m * std::max(0.0F, cells - 0.5F));
                 });
}

Eigen::Vector2i ClearanceGrid::CellOf(const Eigen::Vector2d& position) const {
  constexpr double kFarthest = 1e8;
  const Eigen::Array2d cell = ((position - grid_.origin) / grid_.resolution_m).array().floor();
  return cell.max(-kFarthest).min(kFarthest).cast<int>();
}

Eigen::Vector2d ClearanceGrid::CenterOf(const Eigen::Vector2i& cell) const {
  return grid_.origin + grid_.resolution_m * (cell.cast<double>() + Eigen::Vector2d::Constant(0.5));
}

bool ClearanceGrid::Contains(const Eigen::Vector2i& cell) const {
  return cell.x() >= 0 && cell.y() >= 0 && cell.x() < grid_.width && cell.y() < grid_.height;
}

double ClearanceGrid::ClearanceAt(const Eigen::Vector2i& cell) const {
  if (!Contains(cell)) return outside_m_;
  return static_cast<double>(
      clearance_m_[static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(grid_.width) +
                   static_cast<std::size_t>(cell.x())]);
}

}  // namespace hv::navigation
