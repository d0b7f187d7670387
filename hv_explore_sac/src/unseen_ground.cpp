#include "hv_explore_sac/unseen_ground.h"

#include <limits>

#include <opencv2/imgproc.hpp>

namespace hv::explore {
namespace {

constexpr int kRim = 1;  ///< cells around the belief that stand for all beyond it

/// Where the robot could get to, numbered by which of them are joined, 0 where it cannot stand.
cv::Mat JoinedParts(const Belief& ground) {
  cv::Mat open(ground.height() + 2 * kRim, ground.width() + 2 * kRim, CV_8U, cv::Scalar(255));
  for (int y = 0; y < ground.height(); ++y) {
    auto* row = open.ptr<std::uint8_t>(y + kRim) + kRim;
    for (int x = 0; x < ground.width(); ++x) {
      if (ground.At(y * ground.width() + x) == Cell::kOccupied) row[x] = 0;
    }
  }
  cv::Mat parts;
  constexpr int kSides = 4;  // a robot drives from a cell to those beside it
  cv::connectedComponents(open, parts, kSides);
  return parts;
}

/// Of each cell to the nearest unseen ground [cells].
cv::Mat DistancesToUnseen(const Belief& ground, const Eigen::Vector2i& robot) {
  const cv::Mat parts = JoinedParts(ground);
  const Eigen::Vector2i at = robot - ground.low();
  const int own = parts.at<int>(at.y() + kRim, at.x() + kRim);
  cv::Mat elsewhere(parts.size(), CV_8U, cv::Scalar(255));
  for (int y = 0; y < elsewhere.rows; ++y) {
    for (int x = 0; x < elsewhere.cols; ++x) {
      const Eigen::Vector2i cell = ground.low() + Eigen::Vector2i(x - kRim, y - kRim);
      const bool unseen = !ground.Contains(cell) || ground.At(cell) == Cell::kUnknown;
      if (unseen && parts.at<int>(y, x) == own) elsewhere.at<std::uint8_t>(y, x) = 0;
    }
  }
  cv::Mat distances(elsewhere.size(), CV_32F, cv::Scalar(std::numeric_limits<float>::max()));
  const bool all_seen = cv::countNonZero(elsewhere) == elsewhere.rows * elsewhere.cols;
  if (!all_seen) cv::distanceTransform(elsewhere, distances, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return distances;
}

}  // namespace

void CloseAllBut(const Belief& ground, const Eigen::Vector2i& robot, double reach, Belief& belief) {
  const cv::Mat distances = DistancesToUnseen(ground, robot);
  for (int index = 0; index < belief.width() * belief.height(); ++index) {
    if (belief.At(index) != Cell::kUnknown) continue;
    const Eigen::Vector2i cell = belief.CellOf(index) - belief.low();
    const float distance = distances.at<float>(cell.y() + kRim, cell.x() + kRim);
    if (static_cast<double>(distance) > reach) belief.Set(index, Cell::kOccupied);
  }
}

}  // namespace hv::explore
