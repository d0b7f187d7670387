#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_lio/voxel.h"

namespace hv::lio {

struct PlaneMergeConfig {
  bool enabled = true;
  double angle_deg = 3.0;
  double distance_m = 0.01;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Joins the planes of settled neighbouring voxels into larger ones (paper 3.1, squares of
/// Fig. 12). A merged plane is the fit to the sums of its members; a member can leave again, and
/// takes its sums along. Slots are those of the voxel table. Memory grows with the number of merged
/// planes, which never exceeds half the capacity.
class PlaneMerger {
 public:
  PlaneMerger(const PlaneMergeConfig& config, const VoxelFitConfig& fit, std::size_t capacity);

  /// A voxel that has settled on a plane: `sums` about `origin` [m, odom], frozen until Leave.
  struct Candidate {
    std::uint32_t slot = kNoIndex;
    const Voxel* voxel = nullptr;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  };

  /// Tries to put two neighbours into one plane. True when they share a plane afterwards.
  bool TryMerge(const Candidate& a, const Candidate& b);

  /// Takes the candidate out of its merged plane, if it is in one.
  void Leave(const Candidate& member);

  /// Id of the merged plane of a slot, 0 for none.
  std::uint32_t PlaneOf(std::uint32_t slot) const { return members_[slot].plane; }
  const SurfaceFeature& feature(std::uint32_t plane) const { return planes_[plane].feature; }
  std::size_t MemberCount(std::uint32_t plane) const { return planes_[plane].count; }

  /// Number of merged planes.
  std::size_t size() const { return planes_.size() - 1 - free_.size(); }

  void Clear();

 private:
  struct Member {
    std::uint32_t plane = 0;
    std::uint32_t previous = kNoIndex;
    std::uint32_t next = kNoIndex;
  };
  struct Plane {
    PointSums sums;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    double information = 0.0;
    SurfaceFeature feature;
    std::uint32_t first = kNoIndex;
    std::uint32_t count = 0;
  };

  bool Agree(const SurfaceFeature& a, const SurfaceFeature& b) const;
  bool FitsTogether(const Plane& a, const Plane& b, SurfaceFeature& feature) const;
  const SurfaceFeature& FeatureOf(const Candidate& candidate) const;
  std::uint32_t PlaneWith(const Candidate& candidate);
  Plane Single(const Candidate& candidate) const;
  void Link(std::uint32_t slot, std::uint32_t plane);
  void Unlink(std::uint32_t slot);
  void Absorb(std::uint32_t large, std::uint32_t small);
  void Release(std::uint32_t plane);

  PlaneMergeConfig config_;
  VoxelFitConfig fit_;
  std::vector<Member> members_;
  std::vector<Plane> planes_;  ///< [0] stands for none
  std::vector<std::uint32_t> free_;
};

}  // namespace hv::lio
