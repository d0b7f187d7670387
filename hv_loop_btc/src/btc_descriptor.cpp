#include "hv_loop_btc/btc_descriptor.h"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "hv_loop_btc/height_image.h"

namespace hv::loop {
namespace {

/// A triangle is flat when its longest side is nearly as long as the other two together.
constexpr float kFlatness = 0.95F;

/// The `count` keypoints nearest to each, nearest first.
std::vector<std::vector<std::uint16_t>> Neighbors(const std::vector<BtcKeypoint>& keypoints,
                                                  const BtcScale& scale) {
  std::vector<std::vector<std::uint16_t>> neighbors(keypoints.size());
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    std::vector<std::pair<float, std::uint16_t>> near;
    for (std::size_t j = 0; j < keypoints.size(); ++j) {
      const float distance = (keypoints[i].position - keypoints[j].position).norm();
      const bool usable = distance >= static_cast<float>(scale.min_side_m) &&
                          distance <= static_cast<float>(scale.max_side_m);
      if (i != j && usable) near.emplace_back(distance, static_cast<std::uint16_t>(j));
    }
    const std::size_t count = std::min(near.size(), static_cast<std::size_t>(scale.neighbors));
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
    for (std::size_t n = 0; n < count; ++n) neighbors[i].push_back(near[n].second);
  }
  return neighbors;
}

/// Orders the vertices by the side opposite to them.
BtcTriangle Ordered(const std::vector<BtcKeypoint>& keypoints, std::array<std::uint16_t, 3> ids) {
  const auto opposite = [&](std::size_t k) {
    return (keypoints[ids[(k + 1) % 3]].position - keypoints[ids[(k + 2) % 3]].position).norm();
  };
  std::array<std::pair<float, std::uint16_t>, 3> order;
  for (std::size_t k = 0; k < 3; ++k) order[k] = {opposite(k), ids[k]};
  std::sort(order.begin(), order.end());
  return {{order[0].second, order[1].second, order[2].second}};
}

std::vector<BtcTriangle> MakeTriangles(const std::vector<BtcKeypoint>& keypoints,
                                       const BtcScale& scale, std::size_t limit) {
  const auto neighbors = Neighbors(keypoints, scale);
  std::vector<std::array<std::uint16_t, 3>> ids;
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    for (std::size_t a = 0; a < neighbors[i].size(); ++a) {
      for (std::size_t b = a + 1; b < neighbors[i].size(); ++b) {
        std::array<std::uint16_t, 3> triple{static_cast<std::uint16_t>(i), neighbors[i][a],
                                            neighbors[i][b]};
        std::sort(triple.begin(), triple.end(), std::greater<>());
        ids.push_back(triple);
      }
    }
  }
  // Keypoints are sorted by strength: triangles of strong keypoints come first.
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<BtcTriangle> triangles;
  for (const auto& triple : ids) {
    const BtcTriangle triangle = Ordered(keypoints, triple);
    const auto side = [&](std::size_t a, std::size_t b) {
      return (keypoints[triangle.vertices[a]].position - keypoints[triangle.vertices[b]].position)
          .norm();
    };
    const float longest = side(0, 1);
    const bool flat = longest > kFlatness * (side(0, 2) + side(1, 2));
    const bool sized = side(1, 2) >= static_cast<float>(scale.min_side_m) &&
                       longest <= static_cast<float>(scale.max_side_m);
    if (flat || !sized) continue;
    triangles.push_back(triangle);
    if (triangles.size() == limit) break;
  }
  return triangles;
}

}  // namespace

BtcScale BtcScale::Outdoor() {
  BtcScale scale;
  scale.plane_voxel_m = 2.0;
  scale.cell_m = 0.5;
  scale.slice_m = 0.2;
  scale.min_height_m = 0.5;
  scale.min_bits = 6;
  scale.suppression_m = 2.0;
  scale.neighbors = 10;
  scale.min_side_m = 2.0;
  scale.max_side_m = 50.0;
  scale.vertex_tolerance_m = 1.5;
  scale.plane_distance_m = 0.5;
  scale.loop_distance_m = 10.0;
  scale.confirm_score = 0.3;
  return scale;
}

void BtcScale::Describe(ConfigVisitor& visitor) {
  visitor.Field("plane_voxel_m", plane_voxel_m, "edge of the voxels that planes are sought in [m]");
  visitor.Field("cell_m", cell_m, "cell of the height image [m]");
  visitor.Field("slice_m", slice_m, "slice of height, one bit of 64 [m]");
  visitor.Field("min_height_m", min_height_m, "lowest slice above the floor [m]");
  visitor.Field("min_bits", min_bits, "occupied slices that make a keypoint");
  visitor.Field("suppression_m", suppression_m, "distance between keypoints [m]");
  visitor.Field("neighbors", neighbors, "nearest keypoints that a keypoint forms triangles with");
  visitor.Field("min_side_m", min_side_m, "shortest side of a triangle [m]");
  visitor.Field("max_side_m", max_side_m, "longest side of a triangle [m]");
  visitor.Field("vertex_tolerance_m", vertex_tolerance_m,
                "distance of keypoints that correspond, after alignment [m]");
  visitor.Field("plane_distance_m", plane_distance_m,
                "distance of planes that correspond, after alignment [m]");
  visitor.Field("loop_distance_m", loop_distance_m, "farthest places that make a loop [m]");
  visitor.Field("confirm_score", confirm_score,
                "mean score that loops need while odometry is uncertain, 0 to 1");
}

void BtcScale::Validate(ConfigProblems& problems) const {
  problems.Require(plane_voxel_m > 0.0, "btc.plane_voxel_m", "must be positive");
  problems.Require(cell_m > 0.0, "btc.cell_m", "must be positive");
  problems.Require(slice_m > 0.0, "btc.slice_m", "must be positive");
  problems.Require(min_bits >= 1 && min_bits <= 64, "btc.min_bits", "must lie between 1 and 64");
  problems.Require(suppression_m >= cell_m, "btc.suppression_m", "must be at least cell_m");
  problems.Require(neighbors >= 2, "btc.neighbors", "must be at least 2");
  problems.Require(min_side_m > 0.0 && max_side_m > min_side_m, "btc.max_side_m",
                   "must be larger than min_side_m, which must be positive");
  problems.Require(vertex_tolerance_m > 0.0, "btc.vertex_tolerance_m", "must be positive");
  problems.Require(plane_distance_m > 0.0, "btc.plane_distance_m", "must be positive");
  problems.Require(loop_distance_m > 0.0, "btc.loop_distance_m", "must be positive");
  problems.Require(confirm_score >= 0.0 && confirm_score <= 1.0, "btc.confirm_score",
                   "must lie between 0 and 1");
}

void BtcConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("scale", scale, "indoor, outdoor, or auto: decided by the first submap");
  visitor.Field("outdoor_range_m", outdoor_range_m,
                "auto: outdoor when a fifth of the points are farther than this [m]");
  visitor.Field("max_keypoints", max_keypoints, "strongest keypoints kept of a submap");
  visitor.Field("max_triangles", max_triangles, "triangles kept of a submap");
  visitor.Field("side_bin_m", side_bin_m, "bin of the lengths of sides [m]");
  visitor.Field("min_similarity", min_similarity,
                "similarity of the bits of triangles that correspond (Eq. 11), 0 to 1");
  visitor.Section("indoor", indoor, "sizes of the scale indoor");
  visitor.Section("outdoor", outdoor, "sizes of the scale outdoor");
}

void BtcConfig::Validate(ConfigProblems& problems) const {
  problems.Require(scale == "auto" || scale == "indoor" || scale == "outdoor", "btc.scale",
                   "must be auto, indoor or outdoor");
  problems.Require(outdoor_range_m > 0.0, "btc.outdoor_range_m", "must be positive");
  problems.Require(max_keypoints >= 3 && max_keypoints <= 60000, "btc.max_keypoints",
                   "must lie between 3 and 60000");
  problems.Require(max_triangles >= 1 && max_triangles <= 60000, "btc.max_triangles",
                   "must lie between 1 and 60000");
  problems.Require(side_bin_m > 0.0, "btc.side_bin_m", "must be positive");
  problems.Require(min_similarity >= 0.0 && min_similarity <= 1.0, "btc.min_similarity",
                   "must lie between 0 and 1");
  indoor.Validate(problems);
  outdoor.Validate(problems);
}

double BitSimilarity(std::uint64_t a, std::uint64_t b) {
  const std::size_t total = std::bitset<64>(a).count() + std::bitset<64>(b).count();
  if (total == 0) return 0.0;
  return 2.0 * static_cast<double>(std::bitset<64>(a & b).count()) / static_cast<double>(total);
}

Eigen::Vector3f BtcDescriptor::Sides(const BtcTriangle& triangle) const {
  const auto side = [&](std::size_t a, std::size_t b) {
    return (keypoints[triangle.vertices[a]].position - keypoints[triangle.vertices[b]].position)
        .norm();
  };
  return {side(1, 2), side(0, 2), side(0, 1)};
}

std::size_t BtcDescriptor::MemoryBytes() const {
  return sizeof(BtcDescriptor) + keypoints.size() * sizeof(BtcKeypoint) +
         triangles.size() * sizeof(BtcTriangle) + planes.size() * sizeof(PlaneVoxel);
}

const BtcScale& BtcExtractor::scale() const {
  return config_.scale == "outdoor" ? config_.outdoor : config_.indoor;
}

void BtcExtractor::DecideScale(const std::vector<Eigen::Vector3f>& points) {
  const float limit = static_cast<float>(config_.outdoor_range_m);
  const auto far = std::count_if(points.begin(), points.end(), [limit](const Eigen::Vector3f& p) {
    return p.squaredNorm() > limit * limit;
  });
  const bool outdoor = 5 * static_cast<std::size_t>(far) > points.size();
  config_.scale = outdoor ? "outdoor" : "indoor";
}

BtcDescriptor BtcExtractor::Extract(const Submap& submap) {
  if (config_.scale == "auto") DecideScale(submap.points);
  BtcDescriptor descriptor;
  descriptor.keyframe = submap.keyframe;
  descriptor.planes = ExtractPlaneVoxels(submap.points, {scale().plane_voxel_m, 10, 0.1});
  const ReferencePlane floor = FindFloor(descriptor.planes, submap.up, submap.points);
  const HeightImage image(submap.points, floor, scale());
  descriptor.keypoints = image.Keypoints(static_cast<std::size_t>(config_.max_keypoints));
  descriptor.triangles =
      MakeTriangles(descriptor.keypoints, scale(), static_cast<std::size_t>(config_.max_triangles));
  return descriptor;
}

}  // namespace hv::loop
