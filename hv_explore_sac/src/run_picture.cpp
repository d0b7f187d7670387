#include <cstdio>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "hv_explore_sac/exploration_run.h"

namespace hv::explore {
namespace {

const cv::Scalar kWallColour(90, 84, 80);
const cv::Scalar kStartColour(60, 160, 60);

cv::Mat DrawMap(const ExplorationMap& map) {
  cv::Mat image(map.height, map.width, CV_8UC3, kWallColour);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      if (map.IsFree(map.IndexOf({x, y}))) image.at<cv::Vec3b>(y, x) = {255, 255, 255};
    }
  }
  return image;
}

/// From blue at the start of the run to red at its end.
cv::Scalar ColourAt(double share) { return {255.0 * (1.0 - share), 64.0, 255.0 * share}; }

}  // namespace

void DrawRun(const ExplorationMap& map, const RunResult& run, const std::string& path) {
  cv::Mat image = DrawMap(map);
  const auto pixel = [](const Eigen::Vector2i& cell) { return cv::Point(cell.x(), cell.y()); };
  for (std::size_t i = 1; i < run.path.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(run.path.size());
    cv::line(image, pixel(run.path[i - 1]), pixel(run.path[i]), ColourAt(share), 2, cv::LINE_AA);
    cv::circle(image, pixel(run.path[i]), 3, ColourAt(share), cv::FILLED, cv::LINE_AA);
  }
  cv::circle(image, pixel(map.start), 6, kStartColour, cv::FILLED, cv::LINE_AA);
  // Rows of grids of metres go up, those of pictures down.
  if (map.unit != "px") cv::flip(image, image, 0);
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes);
  WriteFile(path, {std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size())});
}

void WritePath(const ExplorationMap& map, const RunResult& run, const std::string& path) {
  std::string text;
  for (const Eigen::Vector2i& cell : run.path) {
    const Eigen::Vector2d place = map.origin + map.cell_size * cell.cast<double>();
    char line[80];
    std::snprintf(line, sizeof(line), "%.3f %.3f\n", place.x(), place.y());
    text += line;
  }
  WriteFile(path, {text});
}

}  // namespace hv::explore
