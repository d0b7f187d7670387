#include "hv_lio/plane_merger.h"

#include <algorithm>
#include <cmath>

#include "hv_core/angles.h"

namespace hv::lio {

void PlaneMergeConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("enabled", enabled, "merge coplanar neighbouring voxels");
  visitor.Field("angle_deg", angle_deg, "largest angle between the normals of one plane [deg]");
  visitor.Field("distance_m", distance_m, "largest distance of a member from the plane [m]");
}

void PlaneMergeConfig::Validate(ConfigProblems& problems) const {
  problems.Require(angle_deg > 0.0 && angle_deg < 45.0, "map.merge.angle_deg",
                   "must lie between 0 and 45");
  problems.Require(distance_m > 0.0, "map.merge.distance_m", "must be positive");
}

PlaneMerger::PlaneMerger(const PlaneMergeConfig& config, const VoxelFitConfig& fit,
                         std::size_t capacity)
    : config_(config), fit_(fit), members_(capacity), planes_(1) {}

void PlaneMerger::Clear() {
  members_.assign(members_.size(), Member());
  planes_.resize(1);
  free_.clear();
}

bool PlaneMerger::Agree(const SurfaceFeature& a, const SurfaceFeature& b) const {
  const double cosine = std::abs(a.normal().dot(b.normal()));
  if (cosine < std::cos(config_.angle_deg * kRadiansPerDegree)) return false;
  return std::abs(a.normal().dot(b.center - a.center)) < config_.distance_m &&
         std::abs(b.normal().dot(b.center - a.center)) < config_.distance_m;
}

bool PlaneMerger::FitsTogether(const Plane& a, const Plane& b, SurfaceFeature& feature) const {
  PointSums sums = a.sums;
  sums.Combine(b.sums, b.origin - a.origin, 1.0);
  FitFeature(sums, a.origin, a.information + b.information, fit_, feature);
  if (feature.kind != SurfaceFeature::Kind::kPlane) return false;
  const auto distance = [&feature](const Plane& part) {
    return std::abs(feature.normal().dot(part.origin + part.sums.Mean() - feature.center));
  };
  return distance(a) < config_.distance_m && distance(b) < config_.distance_m;
}

const SurfaceFeature& PlaneMerger::FeatureOf(const Candidate& candidate) const {
  const std::uint32_t plane = PlaneOf(candidate.slot);
  return plane == 0 ? candidate.voxel->feature : planes_[plane].feature;
}

PlaneMerger::Plane PlaneMerger::Single(const Candidate& candidate) const {
  Plane plane;
  plane.sums = candidate.voxel->sums;
  plane.origin = candidate.origin;
  plane.information = candidate.voxel->information;
  plane.feature = candidate.voxel->feature;
  return plane;
}

std::uint32_t PlaneMerger::PlaneWith(const Candidate& candidate) {
  if (PlaneOf(candidate.slot) != 0) return PlaneOf(candidate.slot);
  std::uint32_t id = 0;
  if (free_.empty()) {
    id = static_cast<std::uint32_t>(planes_.size());
    planes_.emplace_back();
  } else {
    id = free_.back();
    free_.pop_back();
  }
  planes_[id] = Single(candidate);
  Link(candidate.slot, id);
  return id;
}

bool PlaneMerger::TryMerge(const Candidate& a, const Candidate& b) {
  if (!config_.enabled) return false;
  const std::uint32_t plane_a = PlaneOf(a.slot);
  const std::uint32_t plane_b = PlaneOf(b.slot);
  if (plane_a != 0 && plane_a == plane_b) return true;
  if (!Agree(a.voxel->feature, b.voxel->feature) || !Agree(FeatureOf(a), b.voxel->feature) ||
      !Agree(a.voxel->feature, FeatureOf(b))) {
    return false;
  }
  const Plane side_a = plane_a == 0 ? Single(a) : planes_[plane_a];
  const Plane side_b = plane_b == 0 ? Single(b) : planes_[plane_b];
  SurfaceFeature together;
  if (!FitsTogether(side_a, side_b, together)) return false;
  std::uint32_t large = PlaneWith(a);
  std::uint32_t small = PlaneWith(b);
  if (planes_[large].count < planes_[small].count) std::swap(large, small);
  Absorb(large, small);
  return true;
}

void PlaneMerger::Absorb(std::uint32_t large, std::uint32_t small) {
  Plane& kept = planes_[large];
  kept.sums.Combine(planes_[small].sums, planes_[small].origin - kept.origin, 1.0);
  kept.information += planes_[small].information;
  while (planes_[small].first != kNoIndex) {
    const std::uint32_t slot = planes_[small].first;
    Unlink(slot);
    Link(slot, large);
  }
  Release(small);
  FitFeature(kept.sums, kept.origin, kept.information, fit_, kept.feature);
}

void PlaneMerger::Leave(const Candidate& member) {
  const std::uint32_t id = PlaneOf(member.slot);
  if (id == 0) return;
  Plane& plane = planes_[id];
  plane.sums.Combine(member.voxel->sums, member.origin - plane.origin, -1.0);
  plane.information -= member.voxel->information;
  Unlink(member.slot);
  if (plane.count >= 2) {
    FitFeature(plane.sums, plane.origin, plane.information, fit_, plane.feature);
    if (plane.feature.kind == SurfaceFeature::Kind::kPlane) return;
  }
  while (plane.first != kNoIndex) Unlink(plane.first);
  Release(id);
}

void PlaneMerger::Link(std::uint32_t slot, std::uint32_t plane) {
  members_[slot] = {plane, kNoIndex, planes_[plane].first};
  if (planes_[plane].first != kNoIndex) members_[planes_[plane].first].previous = slot;
  planes_[plane].first = slot;
  ++planes_[plane].count;
}

void PlaneMerger::Unlink(std::uint32_t slot) {
  const Member member = members_[slot];
  if (member.previous != kNoIndex) members_[member.previous].next = member.next;
  if (member.next != kNoIndex) members_[member.next].previous = member.previous;
  if (planes_[member.plane].first == slot) planes_[member.plane].first = member.next;
  --planes_[member.plane].count;
  members_[slot] = Member();
}

void PlaneMerger::Release(std::uint32_t plane) {
  planes_[plane] = Plane();
  free_.push_back(plane);
}

}  // namespace hv::lio
