#include "hv_explore_sac/gates.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace hv::explore {
namespace {

constexpr std::uint8_t kYes = 255;

/// 255 where a belief tells `cell`, with one cell more to each side, which tells `beyond`.
cv::Mat CellsThatAre(Cell cell, const Belief& belief, std::uint8_t beyond) {
  cv::Mat mask(belief.height() + 2, belief.width() + 2, CV_8U, cv::Scalar(beyond));
  for (int y = 0; y < belief.height(); ++y) {
    auto* row = mask.ptr<std::uint8_t>(y + 1) + 1;
    for (int x = 0; x < belief.width(); ++x) {
      row[x] = belief.At(y * belief.width() + x) == cell ? kYes : 0;
    }
  }
  return mask;
}

constexpr int kSides = 4;

/// Without what is joined to fewer than so many.
void DropSmallPatches(double least_cells, cv::Mat& mask) {
  cv::Mat patches;
  cv::Mat figures;
  cv::Mat centers;
  const int count = cv::connectedComponentsWithStats(mask, patches, figures, centers, kSides);
  std::vector<std::uint8_t> kept(static_cast<std::size_t>(count), 0);
  for (int patch = 1; patch < count; ++patch) {
    const bool large = figures.at<int>(patch, cv::CC_STAT_AREA) >= least_cells;
    kept[static_cast<std::size_t>(patch)] = large ? kYes : 0;
  }
  for (int y = 0; y < mask.rows; ++y) {
    const int* const patch = patches.ptr<int>(y);
    std::transform(patch, patch + mask.cols, mask.ptr<std::uint8_t>(y),
                   [&](int of) { return kept[static_cast<std::size_t>(of)]; });
  }
}

cv::Mat GatesOf(const Belief& ground, const Eigen::Vector2i& robot, double least_cells) {
  cv::Mat parts;
  cv::connectedComponents(CellsThatAre(Cell::kFree, ground, 0), parts, kSides);
  const Eigen::Vector2i at = robot - ground.low() + Eigen::Vector2i::Ones();
  const cv::Mat joined = parts == parts.at<int>(at.y(), at.x());
  cv::Mat beside;
  cv::dilate(joined, beside, cv::getStructuringElement(cv::MORPH_CROSS, {3, 3}));
  cv::Mat unseen = CellsThatAre(Cell::kUnknown, ground, kYes);
  DropSmallPatches(least_cells, unseen);
  return beside & unseen;
}

/// Of each cell to the nearest one of the mask [cells].
cv::Mat DistancesTo(const cv::Mat& mask) {
  cv::Mat distances(mask.size(), CV_32F, cv::Scalar(std::numeric_limits<float>::max()));
  if (cv::countNonZero(mask) > 0) {
    cv::distanceTransform(~mask, distances, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  }
  return distances;
}

}  // namespace

void CloseBesideGates(const Belief& ground, const Eigen::Vector2i& robot, const GateRules& rules,
                      Belief& belief) {
  const cv::Mat to_gates = DistancesTo(GatesOf(ground, robot, rules.least_cells));
  const cv::Mat to_free = DistancesTo(CellsThatAre(Cell::kFree, belief, 0));
  const cv::Mat closed = (to_gates > rules.around) & (to_free <= rules.beyond);
  for (int index = 0; index < belief.width() * belief.height(); ++index) {
    if (belief.At(index) != Cell::kUnknown) continue;
    const Eigen::Vector2i at = belief.CellOf(index) - belief.low() + Eigen::Vector2i::Ones();
    if (closed.at<std::uint8_t>(at.y(), at.x()) != 0) belief.Set(index, Cell::kOccupied);
  }
}

}  // namespace hv::explore
