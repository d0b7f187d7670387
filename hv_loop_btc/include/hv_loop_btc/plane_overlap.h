#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "hv_core/se3.h"
#include "hv_loop_btc/plane_voxels.h"

namespace hv::loop {

/// Looks up the plane voxels of a submap by place.
class PlaneIndex {
 public:
  /// Keeps a reference to `planes`. `voxel_m`: edge of the voxels they were extracted with.
  PlaneIndex(const std::vector<PlaneVoxel>& planes, double voxel_m);

  /// Share of `planes`, moved by `T_index_planes`, that lie in a plane voxel of this index: normals
  /// within 12 deg, both centres within `distance_m` of the other's plane (methods section 2, step
  /// 6). In [0, 1]; 0 for no planes.
  double Overlap(const std::vector<PlaneVoxel>& planes, const Pose& T_index_planes,
                 double distance_m) const;

 private:
  bool Matches(const PlaneVoxel& moved, float distance) const;

  const std::vector<PlaneVoxel>& planes_;
  float inverse_size_;
  std::unordered_map<std::uint64_t, std::uint32_t> index_;
};

}  // namespace hv::loop
