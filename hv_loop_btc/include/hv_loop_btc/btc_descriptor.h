#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_loop_btc/plane_voxels.h"
#include "hv_loop_btc/submap.h"

namespace hv::loop {

/// Sizes that follow the scale of the place.
struct BtcScale {
  double plane_voxel_m = 0.5;
  double cell_m = 0.2;
  double slice_m = 0.1;
  double min_height_m = 0.2;
  int min_bits = 6;
  double suppression_m = 1.0;
  int neighbors = 10;
  double min_side_m = 1.0;
  double max_side_m = 25.0;
  double vertex_tolerance_m = 0.5;
  double plane_distance_m = 0.25;
  double loop_distance_m = 5.0;
  double confirm_score = 0.45;

  static BtcScale Indoor() { return BtcScale(); }
  static BtcScale Outdoor();
  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

struct BtcConfig {
  std::string scale = "auto";
  double outdoor_range_m = 15.0;
  int max_keypoints = 80;
  int max_triangles = 1500;
  double side_bin_m = 0.3;
  double min_similarity = 0.55;
  BtcScale indoor = BtcScale::Indoor();
  BtcScale outdoor = BtcScale::Outdoor();

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// A place that stands out of its surroundings, seen from above.
struct BtcKeypoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< on the reference plane, submap frame [m]
  std::uint64_t bits = 0;  ///< occupied slices of height above the plane, lowest first
};

/// Three keypoints; the vertices are ordered by the length of the opposite side, shortest first, so
/// that equal triangles correspond vertex by vertex.
struct BtcTriangle {
  std::array<std::uint16_t, 3> vertices{};
};

/// Boundary triangle descriptor of one submap (paper 3.2, methods section 2).
struct BtcDescriptor {
  std::uint32_t keyframe = 0;
  std::vector<BtcKeypoint> keypoints;
  std::vector<BtcTriangle> triangles;
  std::vector<PlaneVoxel> planes;  ///< for verification

  /// Lengths of the sides of a triangle, ascending [m].
  Eigen::Vector3f Sides(const BtcTriangle& triangle) const;
  std::size_t MemoryBytes() const;
};

/// Eq. 11: 2 |a & b| / (|a| + |b|), in [0, 1].
double BitSimilarity(std::uint64_t a, std::uint64_t b);

/// Makes descriptors. The scale of an `auto` configuration is decided by the first submap and kept,
/// since descriptors of different scales do not match. Not thread-safe.
class BtcExtractor {
 public:
  explicit BtcExtractor(const BtcConfig& config) : config_(config) {}

  BtcDescriptor Extract(const Submap& submap);

  /// "indoor", "outdoor", or "auto" while undecided; Extract decides.
  const std::string& scale_name() const { return config_.scale; }
  /// Continues with the scale that stored descriptors were made with.
  void SetScale(const std::string& name) { config_.scale = name; }
  const BtcScale& scale() const;

 private:
  void DecideScale(const std::vector<Eigen::Vector3f>& points);

  BtcConfig config_;
};

}  // namespace hv::loop
