#include "hv_relocalize_ndt/place_score.h"

#include <algorithm>
#include <cmath>

namespace hv::relocalize {
namespace {

/// Cosine to the vertical beyond which a plane is floor or ceiling.
constexpr float kFlatCosine = 0.8F;
/// Cosine between normals of one surface, at least.
constexpr float kSameNormal = 0.85F;
/// Squared Mahalanobis distance up to which a point belongs to what is no plane.
constexpr float kInBlob = 9.0F;
/// Share of the map that a scan may see through before its score falls to a third.
constexpr double kSeenThroughScale = 0.1;

}  // namespace

void PlaceScoreConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("max_distance_m", max_distance_m,
                "distance from a surface of the map at which one of the scan lies on it [m]");
  visitor.Field("max_range_m", max_range_m, "how far around the scan surfaces are compared [m]");
}

void PlaceScoreConfig::Validate(ConfigProblems& problems) const {
  problems.Require(max_distance_m > 0.0, "score.max_distance_m", "must be positive");
  problems.Require(max_range_m > 0.0, "score.max_range_m", "must be positive");
}

double PlaceScore::score() const { return fit * std::exp(-seen_through / kSeenThroughScale); }

double PlaceScore::agreement() const { return overlap > 0.0 ? fit / overlap : 0.0; }

PlaceJudge::PlaceJudge(const PlaceScoreConfig& config, const NdtLevel& map_surfaces,
                       const NdtLevel& scan_surfaces, const std::vector<Eigen::Vector3f>& scan,
                       const Eigen::Vector3d& up)
    : config_(config), map_(map_surfaces), view_(scan) {
  const Eigen::Vector3f vertical = up.cast<float>();
  for (const NdtVoxel& voxel : scan_surfaces.voxels()) {
    if (voxel.mean.norm() > static_cast<float>(config.max_range_m)) continue;
    const bool level = voxel.planar() && std::abs(voxel.normal.dot(vertical)) > kFlatCosine;
    if (!level) upright_.push_back(voxel);
  }
}

PlaceJudge::Place PlaceJudge::PlaceOf(const NdtVoxel& surface,
                                      const Eigen::Isometry3f& T_map_scan) const {
  const Eigen::Vector3f place = T_map_scan * surface.mean;
  const NdtLevel::Neighbors* around = map_.Around(place);
  if (around == nullptr) return Place::kUnknown;
  const Eigen::Vector3f normal = T_map_scan.linear() * surface.normal;
  for (std::uint32_t k = 0; k < around->count; ++k) {
    const NdtVoxel& voxel = map_.voxels()[around->voxels[k]];
    const Eigen::Vector3f offset = place - voxel.mean;
    if (!voxel.planar() || !surface.planar()) {
      if (offset.dot(voxel.information * offset) < kInBlob) return Place::kOn;
      continue;
    }
    if (std::abs(normal.dot(voxel.normal)) < kSameNormal) continue;
    const float across = std::abs(offset.dot(voxel.normal));
    if (across < static_cast<float>(config_.max_distance_m)) return Place::kOn;
  }
  return Place::kOff;
}

double PlaceJudge::Lead(const Pose& T_map_scan, const Pose& T_map_scan_other) const {
  const Eigen::Isometry3f one = T_map_scan.cast<float>();
  const Eigen::Isometry3f other = T_map_scan_other.cast<float>();
  double only_one = 0.0;
  double only_other = 0.0;
  for (const NdtVoxel& surface : upright_) {
    const bool fits_one = PlaceOf(surface, one) == Place::kOn;
    const bool fits_other = PlaceOf(surface, other) == Place::kOn;
    only_one += fits_one && !fits_other ? 1.0 : 0.0;
    only_other += fits_other && !fits_one ? 1.0 : 0.0;
  }
  const double differing = only_one + only_other;
  return differing > 0.0 ? (only_one - only_other) / std::sqrt(differing) : 0.0;
}

PlaceScore PlaceJudge::Judge(const Pose& T_map_scan) const {
  PlaceScore score;
  if (upright_.empty()) return score;
  const Eigen::Isometry3f transform = T_map_scan.cast<float>();
  std::size_t on_surface = 0;
  std::size_t known_places = 0;
  for (const NdtVoxel& surface : upright_) {
    const Place place = PlaceOf(surface, transform);
    on_surface += place == Place::kOn ? 1 : 0;
    known_places += place != Place::kUnknown ? 1 : 0;
  }
  const auto count = static_cast<double>(upright_.size());
  score.fit = static_cast<double>(on_surface) / count;
  score.overlap = static_cast<double>(known_places) / count;
  const Eigen::Vector3f sensor = transform.translation();
  std::vector<Eigen::Vector3f> near;
  for (const NdtVoxel& voxel : map_.voxels()) {
    if ((voxel.mean - sensor).norm() < static_cast<float>(config_.max_range_m)) {
      near.push_back(voxel.mean);
    }
  }
  const loop::ViewImage::Comparison seen = view_.Compare(near, T_map_scan.inverse());
  if (seen.compared > 0) {
    score.seen_through =
        static_cast<double>(seen.seen_through) / static_cast<double>(seen.compared);
  }
  return score;
}

}  // namespace hv::relocalize
