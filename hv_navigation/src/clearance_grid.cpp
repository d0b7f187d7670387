#include "hv_navigation/clearance_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
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
      unknown_(unknown),
      cells_per_m_(1.0 / grid_.resolution_m),
      outside_m_(unknown == Unknown::kOccupied ? 0.0 : limit_m),
      limit_m_(limit_m),
      clearance_m_(grid_.cells.size(), static_cast<float>(limit_m)) {
  if (grid_.cells.empty()) return;
  Measure({Eigen::Vector2i::Zero(), Eigen::Vector2i(grid_.width - 1, grid_.height - 1)});
}

/// No distance changes that is farther from a change than this.
int ClearanceGrid::ReachInCells() const {
  return static_cast<int>(std::ceil(limit_m_ * cells_per_m_)) + 1;
}

ClearanceGrid ClearanceGrid::WithCells(OccupancyGrid grid, const CellBox& changed) const {
  ClearanceGrid result = *this;
  result.grid_ = std::move(grid);
  const Eigen::Array2i last(grid_.width - 1, grid_.height - 1);
  result.Measure({(changed.low.array() - ReachInCells()).max(0).matrix(),
                  (changed.high.array() + ReachInCells()).min(last).matrix()});
  return result;
}

/// Sets the distances inside `box`.
void ClearanceGrid::Measure(const CellBox& box) {
  const Eigen::Array2i last(grid_.width - 1, grid_.height - 1);
  const Eigen::Array2i low = (box.low.array() - ReachInCells()).max(0);
  const Eigen::Array2i high = (box.high.array() + ReachInCells()).min(last);
  cv::Mat free(high.y() - low.y() + 1, high.x() - low.x() + 1, CV_8U);
  for (int row = 0; row < free.rows; ++row) {
    const auto* cells = &grid_.cells[IndexOf(low.x(), low.y() + row)];
    std::transform(cells, cells + free.cols, free.ptr<std::uint8_t>(row),
                   [this](std::int8_t cell) { return IsClosed(cell, unknown_) ? 0 : 255; });
  }
  const bool all_free = cv::countNonZero(free) == free.rows * free.cols;
  cv::Mat distances(free.size(), CV_32F, cv::Scalar(std::numeric_limits<float>::max()));
  if (!all_free) cv::distanceTransform(free, distances, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  const auto limit = static_cast<float>(limit_m_);
  for (int row = box.low.y(); row <= box.high.y(); ++row) {
    const auto* from = distances.ptr<float>(row - low.y()) + (box.low.x() - low.x());
    std::transform(
        from, from + (box.high.x() - box.low.x() + 1),
        clearance_m_.begin() + static_cast<std::ptrdiff_t>(IndexOf(box.low.x(), row)),
        [&](float cells) { return std::min(limit, BorderDistance(cells, grid_.resolution_m)); });
  }
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
  low = (low - ReachInCells()).max(0);
  high = (high + ReachInCells()).min(Eigen::Array2i(grid_.width, grid_.height) - 1);
  cv::Mat free(high.y() - low.y() + 1, high.x() - low.x() + 1, CV_8U, cv::Scalar(255));
  for (const Eigen::Vector2i& cell : cells) {
    free.at<std::uint8_t>(cell.y() - low.y(), cell.x() - low.x()) = 0;
  }
  cv::Mat distances;
  cv::distanceTransform(free, distances, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  for (int row = 0; row < distances.rows; ++row) {
    float* clearance = grid.clearance_m_.data() + IndexOf(low.x(), low.y() + row);
    for (int column = 0; column < distances.cols; ++column) {
      const float distance = BorderDistance(distances.at<float>(row, column), grid_.resolution_m);
      clearance[column] = std::min(clearance[column], distance);
    }
  }
  return grid;
}

}  // namespace hv::navigation
