#include "hv_loop_btc/view_image.h"

#include <algorithm>
#include <cmath>

namespace hv::loop {
namespace {

/// Cells of three degrees: thinned clouds leave no holes in walls that are less than 5 m away at
/// right angles, and neighbours close those beyond.
constexpr int kColumns = 120;
constexpr int kRows = 60;
constexpr float kPi = 3.14159265F;
/// A point is seen through when the view reaches this far beyond it [m], and this share of range.
constexpr float kBeyond_m = 0.4F;
constexpr float kBeyondShare = 0.1F;
/// Nearer than this, the person who carries the sensor and the mount may stand in the view [m].
constexpr float kNear_m = 0.7F;

struct Direction {
  int row = 0;
  int column = 0;
  float range = 0.0F;
};

Direction DirectionOf(const Eigen::Vector3f& point) {
  Direction direction;
  direction.range = point.norm();
  const float elevation = std::asin(std::clamp(point.z() / direction.range, -1.0F, 1.0F));
  const float azimuth = std::atan2(point.y(), point.x());
  direction.row = std::min(kRows - 1, static_cast<int>((elevation / kPi + 0.5F) * kRows));
  direction.column =
      std::min(kColumns - 1, static_cast<int>((azimuth / (2.0F * kPi) + 0.5F) * kColumns));
  return direction;
}

}  // namespace

ViewImage::ViewImage(const std::vector<Eigen::Vector3f>& points)
    : ranges_(static_cast<std::size_t>(kRows) * kColumns, 0.0F), nearest_(ranges_) {
  for (const Eigen::Vector3f& point : points) {
    if (!(point.squaredNorm() > kNear_m * kNear_m)) continue;
    const Direction direction = DirectionOf(point);
    float& range = ranges_[Cell(direction.row, direction.column)];
    range = range > 0.0F ? std::min(range, direction.range) : direction.range;
  }
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      nearest_[Cell(row, column)] = NearestAround(row, column);
    }
  }
}

std::size_t ViewImage::Cell(int row, int column) const {
  const int wrapped = (column + kColumns) % kColumns;
  return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(wrapped);
}

float ViewImage::NearestAround(int row, int column) const {
  if (!(ranges_[Cell(row, column)] > 0.0F)) return 0.0F;
  float least = ranges_[Cell(row, column)];
  for (int y = std::max(0, row - 1); y <= std::min(kRows - 1, row + 1); ++y) {
    for (int x = column - 1; x <= column + 1; ++x) {
      const float range = ranges_[Cell(y, x)];
      if (range > 0.0F) least = std::min(least, range);
    }
  }
  return least;
}

ViewImage::Comparison ViewImage::Compare(const std::vector<Eigen::Vector3f>& points,
                                         const Pose& T_view_points) const {
  const Eigen::Isometry3f T = T_view_points.cast<float>();
  Comparison result;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3f moved = T * point;
    if (!(moved.squaredNorm() > kNear_m * kNear_m)) continue;
    const Direction direction = DirectionOf(moved);
    const float seen = nearest_[Cell(direction.row, direction.column)];
    if (!(seen > 0.0F)) continue;
    ++result.compared;
    result.seen_through += direction.range * (1.0F + kBeyondShare) + kBeyond_m < seen ? 1 : 0;
  }
  return result;
}

}  // namespace hv::loop
