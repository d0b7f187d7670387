#include "hv_navigation/clearance_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace hv::navigation {
namespace {

bool IsClosed(std::int8_t cell, ClearanceGrid::Unknown unknown) {
  return cell < 0 ? unknown == ClearanceGrid::Unknown::kOccupied : OccupancyGrid::IsOccupied(cell);
}

/// From the border of the obstacle, not the centre of its cell [m].
float BorderDistance(float cells, double resolution_m) {
  return static_cast<float>(resolution_m) * std::max(0.0F, cells - 0.5F);
}

}  // namespace

ClearanceGrid::ClearanceGrid(OccupancyGrid grid, Unknown unknown, double limit_m)
    : grid_(std::move(grid)),
      cells_per_m_(1.0 / grid_.resolution_m),
      outside_m_(unknown == Unknown::kOccupied ? 0.0 : limit_m),
      limit_m_(limit_m),
      clearance_m_(grid_.cells.size(), static_cast<float>(limit_m)) {
  if (grid_.cells.empty()) return;
  cv::Mat free(grid_.height, grid_.width, CV_8U);
  std::transform(grid_.cells.begin(), grid_.cells.end(), free.begin<std::uint8_t>(),
                 [unknown](std::int8_t cell) { return IsClosed(cell, unknown) ? 0 : 255; });
  if (cv::countNonZero(free) == static_cast<int>(grid_.cells.size())) return;
  cv::Mat distances;
  cv::distanceTransform(free, distances, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  const auto limit = static_cast<float>(limit_m);
  std::transform(
      distances.begin<float>(), distances.end<float>(), clearance_m_.begin(),
      [&](float cells) { return std::min(limit, BorderDistance(cells, grid_.resolution_m)); });
}

ClearanceGrid ClearanceGrid::WithObstacles(const std::vector<Eigen::Vector2i>& cells) const {
  ClearanceGrid grid = *this;
  if (cells.empty()) return grid;
  Eigen::Array2i low = cells.front();
  Eigen::Array2i high = cells.front();
  for (const Eigen::Vector2i& cell : cells) {
    grid.grid_.At(cell.x(), cell.y()) = OccupancyGrid::kOccupied;
    low = low.min(cell.array());
    high = high.max(cell.array());
  }
  // No distance farther away than the limit changes.
  const int reach = static_cast<int>(std::ceil(limit_m_ * cells_per_m_)) + 1;
  low = (low - reach).max(0);
  high = (high + reach).min(Eigen::Array2i(grid_.width, grid_.height) - 1);
  cv::Mat free(high.y() - low.y() + 1, high.x() - low.x() + 1, CV_8U, cv::Scalar(255));
  for (const Eigen::Vector2i& cell : cells) {
    free.at<std::uint8_t>(cell.y() - low.y(), cell.x() - low.x()) = 0;
  }
  cv::Mat distances;
  cv::distanceTransform(free, distances, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  for (int row = 0; row < distances.rows; ++row) {
    const std::ptrdiff_t begin = static_cast<std::ptrdiff_t>(low.y() + row) * grid_.width + low.x();
    float* clearance = grid.clearance_m_.data() + begin;
    for (int column = 0; column < distances.cols; ++column) {
      const float distance = BorderDistance(distances.at<float>(row, column), grid_.resolution_m);
      clearance[column] = std::min(clearance[column], distance);
    }
  }
  return grid;
}

}  // namespace hv::navigation
