#include <filesystem>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "hv_core/occupancy_grid.h"
#include "hv_explore_sac/exploration_map.h"

namespace hv::explore {
namespace {

constexpr int kDarkestFree = 151;
constexpr int kStartGrey = 208;
/// The start is a square of 16 cells; the benchmark takes the last one of its eighth row.
constexpr std::size_t kStartCell = 127;

std::string NameOf(const std::string& path) { return std::filesystem::path(path).stem(); }

cv::Mat Decode(const std::string& path) {
  const std::string bytes = ReadFile(path);
  cv::Mat image;
  if (!bytes.empty()) {
    const cv::Mat buffer(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
    image = cv::imdecode(buffer, cv::IMREAD_GRAYSCALE);
  }
  if (image.empty()) throw InputError(path + ": no image that can be read");
  return image;
}

/// The middle of the widest open place.
Eigen::Vector2i MostOpenCell(const cv::Mat& free) {
  cv::Mat fenced;
  cv::copyMakeBorder(free, fenced, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::Mat distances;
  cv::distanceTransform(fenced, distances, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::Point widest;
  cv::minMaxLoc(distances, nullptr, nullptr, nullptr, &widest);
  return {widest.x - 1, widest.y - 1};
}

/// Leaves of `free` what is connected with `start`.
void KeepConnected(cv::Mat& free, const Eigen::Vector2i& start) {
  constexpr int kReached = 2;
  cv::floodFill(free, cv::Point(start.x(), start.y()), cv::Scalar(kReached), nullptr, cv::Scalar(0),
                cv::Scalar(0), 4);
  free = free == kReached;
}

}  // namespace

ExplorationMap ReadImageMap(const std::string& path) {
  const cv::Mat image = Decode(path);
  ExplorationMap map;
  map.name = NameOf(path);
  map.width = image.cols;
  map.height = image.rows;
  std::vector<Eigen::Vector2i> start;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const int grey = image.at<std::uint8_t>(y, x);
      map.free.push_back(grey >= kDarkestFree ? 1 : 0);
      if (grey == kStartGrey) start.emplace_back(x, y);
    }
  }
  if (start.size() <= kStartCell) throw InputError(path + ": no start (a square of grey 208)");
  map.start = start[kStartCell];
  return map;
}

ExplorationMap ReadGridMap(const std::string& yaml_path) {
  const OccupancyGrid grid = ReadGrid(yaml_path);
  ExplorationMap map;
  map.name = NameOf(yaml_path);
  map.unit = "m";
  map.cell_size = grid.resolution_m;
  map.origin = grid.CenterOf({0, 0});
  map.width = grid.width;
  map.height = grid.height;
  cv::Mat free(grid.height, grid.width, CV_8U);
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const std::int8_t cell = grid.At(x, y);
      free.at<std::uint8_t>(y, x) = cell >= 0 && !OccupancyGrid::IsOccupied(cell) ? 1 : 0;
    }
  }
  if (cv::countNonZero(free) == 0) throw InputError(yaml_path + ": no cell is free");
  map.start = MostOpenCell(free);
  KeepConnected(free, map.start);
  map.free.assign(free.begin<std::uint8_t>(), free.end<std::uint8_t>());
  return map;
}

}  // namespace hv::explore
