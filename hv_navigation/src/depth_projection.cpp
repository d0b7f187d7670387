#include "hv_navigation/depth_projection.h"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace hv::navigation {
namespace {

using Millimetres = std::uint16_t;

bool IsUsable(const DepthImage& image, const DepthCameraModel& camera) {
  if (image.width <= 0 || image.height <= 0) return false;
  const auto pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  const bool model = std::isfinite(camera.fx) && std::isfinite(camera.fy) && camera.fx > 0.0 &&
                     camera.fy > 0.0 && std::isfinite(camera.cx) && std::isfinite(camera.cy);
  return image.depth_mm.size() == pixels && model;
}

/// The image with zeros where the depth is outside of the limits.
cv::Mat WithinLimits(const DepthImage& image, const DepthConfig& config, DepthReport& report) {
  cv::Mat depth(image.height, image.width, CV_16U);
  const auto near = static_cast<int>(std::lround(1e3 * config.min_range_m));
  const auto far = static_cast<int>(std::lround(1e3 * config.max_range_m));
  std::transform(image.depth_mm.begin(), image.depth_mm.end(), depth.begin<Millimetres>(),
                 [&](Millimetres pixel) -> Millimetres {
                   if (pixel == 0) ++report.without_depth;
                   if (pixel >= near && pixel <= far) return pixel;
                   if (pixel != 0) ++report.out_of_range;
                   return 0;
                 });
  return depth;
}

/// Pixels without depth stay without, and none loses its depth to a hole beside it.
void TakeMedian(int edge, cv::Mat& depth) {
  if (edge == 0) return;
  cv::Mat median;
  cv::medianBlur(depth, median, edge);
  std::transform(depth.begin<Millimetres>(), depth.end<Millimetres>(), median.begin<Millimetres>(),
                 depth.begin<Millimetres>(), [](Millimetres pixel, Millimetres filtered) {
                   return pixel == 0 || filtered == 0 ? pixel : filtered;
                 });
}

/// Whether the depth changes at a pixel, from one neighbour to the opposite one, along the ray in
/// both steps: it is the mixture of a near surface and a far one. On the rim of something thin the
/// steps have opposite signs. `least`: depth in a step by its depth.
bool IsBetween(int before, int pixel, int after, double least) {
  if (before == 0 || after == 0) return false;
  const double limit = least * pixel;
  const int in = pixel - before;
  const int out = after - pixel;
  return (in > limit && out > limit) || (in < -limit && out < -limit);
}

void RemoveFlyingPixels(const DepthCameraModel& camera, const DepthConfig& config, cv::Mat& depth,
                        DepthReport& report) {
  const double cotangent = 1.0 / std::tan(config.flying_incidence_deg * M_PI / 180.0);
  const cv::Mat before = depth.clone();
  const auto at = [&](int row, int column) {
    const bool inside = row >= 0 && column >= 0 && row < before.rows && column < before.cols;
    return inside ? static_cast<int>(before.at<Millimetres>(row, column)) : 0;
  };
  for (int row = 0; row < depth.rows; ++row) {
    for (int column = 0; column < depth.cols; ++column) {
      const int pixel = at(row, column);
      if (pixel == 0) continue;
      if (!IsBetween(at(row, column - 1), pixel, at(row, column + 1), cotangent / camera.fx) &&
          !IsBetween(at(row - 1, column), pixel, at(row + 1, column), cotangent / camera.fy)) {
        continue;
      }
      depth.at<Millimetres>(row, column) = 0;
      ++report.flying;
    }
  }
}

void RemoveSpeckles(const DepthConfig& config, cv::Mat& depth, DepthReport& report) {
  if (config.speckle_pixels == 0) return;
  cv::Mat filtered;
  depth.convertTo(filtered, CV_16S);
  cv::filterSpeckles(filtered, 0, config.speckle_pixels, 1e3 * config.speckle_step_m);
  const int before = cv::countNonZero(depth);
  filtered.convertTo(depth, CV_16U);
  report.speckle = static_cast<std::size_t>(before - cv::countNonZero(depth));
}

Point Project(int row, int column, Millimetres millimetres, const DepthCameraModel& camera) {
  const double z = 1e-3 * millimetres;
  Point point;
  point.x = static_cast<float>(z * (column - camera.cx) / camera.fx);
  point.y = static_cast<float>(z * (row - camera.cy) / camera.fy);
  point.z = static_cast<float>(z);
  return point;
}

/// The nearest pixel with depth of a tile.
void ProjectTile(const cv::Mat& depth, const cv::Rect& tile, const DepthCameraModel& camera,
                 std::vector<Point>& points) {
  Millimetres nearest = 0;
  cv::Point place;
  for (int row = tile.y; row < std::min(depth.rows, tile.y + tile.height); ++row) {
    for (int column = tile.x; column < std::min(depth.cols, tile.x + tile.width); ++column) {
      const Millimetres pixel = depth.at<Millimetres>(row, column);
      if (pixel == 0 || (nearest != 0 && pixel >= nearest)) continue;
      nearest = pixel;
      place = {column, row};
    }
  }
  if (nearest != 0) points.push_back(Project(place.y, place.x, nearest, camera));
}

}  // namespace

DepthCloud ProjectDepth(const DepthImage& image, const DepthCameraModel& camera,
                        const DepthConfig& config) {
  DepthCloud cloud;
  cloud.report.pixels = image.depth_mm.size();
  cloud.report.refused = !IsUsable(image, camera);
  if (cloud.report.refused) return cloud;
  cv::Mat depth = WithinLimits(image, config, cloud.report);
  TakeMedian(config.median_pixels, depth);
  RemoveFlyingPixels(camera, config, depth, cloud.report);
  RemoveSpeckles(config, depth, cloud.report);
  const int edge = config.decimation;
  for (int row = 0; row < depth.rows; row += edge) {
    for (int column = 0; column < depth.cols; column += edge) {
      ProjectTile(depth, {column, row, edge, edge}, camera, cloud.points);
    }
  }
  return cloud;
}

}  // namespace hv::navigation
