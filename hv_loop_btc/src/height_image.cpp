#include "hv_loop_btc/height_image.h"

#include <algorithm>
#include <bitset>
#include <cmath>

namespace hv::loop {
namespace {

constexpr int kSlices = 64;
/// Neighbours with at least this share of a cell's bits continue the structure it belongs to.
constexpr double kAlike = 0.5;
/// A structure is a line when its extent across is less than this share of that along it
/// (variances) and the cell lies within this share of the extent from its middle.
constexpr float kLineFlatness = 0.2F;
constexpr float kLineMiddle = 0.5F;
constexpr int kLargestImage = 4000;

int CountBits(std::uint64_t bits) { return static_cast<int>(std::bitset<kSlices>(bits).count()); }

/// Two axes of a plane. They depend on the normal alone, continuously for normals near z.
Eigen::Matrix<float, 2, 3> PlaneAxes(const Eigen::Vector3d& normal) {
  const bool steep = std::abs(normal.x()) > 0.9;
  const Eigen::Vector3d helper = steep ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d first = (helper - normal.dot(helper) * normal).normalized();
  Eigen::Matrix<float, 2, 3> axes;
  axes.row(0) = first.cast<float>();
  axes.row(1) = normal.cross(first).cast<float>();
  return axes;
}

}  // namespace

HeightImage::HeightImage(const std::vector<Eigen::Vector3f>& points, const ReferencePlane& plane,
                         const BtcScale& scale)
    : scale_(scale), plane_(plane), axes_(PlaneAxes(plane.normal)) {
  Eigen::Vector2f low = Eigen::Vector2f::Zero();
  Eigen::Vector2f high = Eigen::Vector2f::Zero();
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector2f flat = axes_ * point;
    low = low.cwiseMin(flat);
    high = high.cwiseMax(flat);
  }
  const float cell = static_cast<float>(scale.cell_m);
  // Whole cells, so that the grid of a place does not depend on how far a scan happened to reach.
  low_ = (low / cell).array().floor().matrix() * cell;
  const Eigen::Vector2f extent = ((high - low_) / cell).array().ceil() + 1.0F;
  width_ = std::min(kLargestImage, static_cast<int>(extent.x()));
  height_ = std::min(kLargestImage, static_cast<int>(extent.y()));
  cells_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  Fill(points);
}

void HeightImage::Fill(const std::vector<Eigen::Vector3f>& points) {
  const Eigen::Vector3f normal = plane_.normal.cast<float>();
  const float offset = static_cast<float>(plane_.offset);
  const float lowest = static_cast<float>(scale_.min_height_m);
  const float per_slice = static_cast<float>(1.0 / scale_.slice_m);
  const float inverse_cell = static_cast<float>(1.0 / scale_.cell_m);
  for (const Eigen::Vector3f& point : points) {
    const float slice = (normal.dot(point) - offset - lowest) * per_slice;
    if (slice < 0.0F || slice >= static_cast<float>(kSlices)) continue;
    const Eigen::Vector2f flat = axes_ * point;
    const int x = static_cast<int>((flat.x() - low_.x()) * inverse_cell);
    const int y = static_cast<int>((flat.y() - low_.y()) * inverse_cell);
    if (!Inside(x, y)) continue;
    Cell& cell = cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                        static_cast<std::size_t>(x)];
    cell.bits |= std::uint64_t{1} << static_cast<unsigned>(slice);
    cell.sum += flat;
    cell.count += 1.0F;
  }
}

int HeightImage::Strength(int x, int y) const {
  return Inside(x, y) ? CountBits(At(x, y).bits) : 0;
}

bool HeightImage::OnLine(const Peak& peak) const {
  const int reach =
      std::max(2, static_cast<int>(std::lround(scale_.suppression_m / scale_.cell_m)));
  const int least = std::max(1, static_cast<int>(kAlike * peak.strength));
  float count = 0.0F;
  Eigen::Vector2f sum = Eigen::Vector2f::Zero();
  Eigen::Matrix2f outer = Eigen::Matrix2f::Zero();
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      if (dx * dx + dy * dy > reach * reach || Strength(peak.x + dx, peak.y + dy) < least) continue;
      const Eigen::Vector2f offset(static_cast<float>(dx), static_cast<float>(dy));
      count += 1.0F;
      sum += offset;
      outer += offset * offset.transpose();
    }
  }
  const Eigen::Vector2f mean = sum / count;
  const Eigen::Matrix2f covariance = outer / count - mean * mean.transpose();
  const float middle = 0.5F * covariance.trace();
  const float spread = std::sqrt(std::max(0.0F, middle * middle - covariance.determinant()));
  const float along = middle + spread;
  const float across = middle - spread;
  const bool thin = across < kLineFlatness * along;
  const bool in_the_middle = mean.squaredNorm() < kLineMiddle * kLineMiddle * along;
  const bool long_enough = along > 0.1F * static_cast<float>(reach * reach);
  return thin && in_the_middle && long_enough;
}

std::vector<HeightImage::Peak> HeightImage::LocalMaxima() const {
  std::vector<Peak> peaks;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Peak peak{x, y, Strength(x, y)};
      if (peak.strength >= scale_.min_bits && !OnLine(peak)) peaks.push_back(peak);
    }
  }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const Peak& a, const Peak& b) { return a.strength > b.strength; });
  const int reach = static_cast<int>(std::lround(scale_.suppression_m / scale_.cell_m));
  std::vector<Peak> kept;
  for (const Peak& peak : peaks) {
    const bool suppressed = std::any_of(kept.begin(), kept.end(), [&](const Peak& other) {
      const int dx = peak.x - other.x;
      const int dy = peak.y - other.y;
      return dx * dx + dy * dy <= reach * reach;
    });
    if (!suppressed) kept.push_back(peak);
  }
  return kept;
}

BtcKeypoint HeightImage::MakeKeypoint(const Peak& peak) const {
  BtcKeypoint keypoint;
  keypoint.bits = At(peak.x, peak.y).bits;
  Eigen::Vector2f sum = Eigen::Vector2f::Zero();
  float weight = 0.0F;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (!Inside(peak.x + dx, peak.y + dy)) continue;
      const Cell& cell = At(peak.x + dx, peak.y + dy);
      if (cell.count == 0.0F) continue;
      const float bits = static_cast<float>(CountBits(cell.bits));
      sum += bits * cell.sum / cell.count;
      weight += bits;
    }
  }
  const Eigen::Vector2f flat = sum / weight;
  keypoint.position = axes_.transpose() * flat + (plane_.offset * plane_.normal).cast<float>();
  return keypoint;
}

std::vector<BtcKeypoint> HeightImage::Keypoints(std::size_t limit) const {
  std::vector<Peak> peaks = LocalMaxima();
  if (peaks.size() > limit) peaks.resize(limit);
  std::vector<BtcKeypoint> keypoints;
  keypoints.reserve(peaks.size());
  for (const Peak& peak : peaks) keypoints.push_back(MakeKeypoint(peak));
  return keypoints;
}

}  // namespace hv::loop
