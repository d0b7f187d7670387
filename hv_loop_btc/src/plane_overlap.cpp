#include "hv_loop_btc/plane_overlap.h"

#include <cmath>

#include "hv_core/cube_key.h"

namespace hv::loop {
namespace {

constexpr float kParallelCosine = 0.978F;  // 12 deg

}  // namespace

PlaneIndex::PlaneIndex(const std::vector<PlaneVoxel>& planes, double voxel_m)
    : planes_(planes), inverse_size_(static_cast<float>(1.0 / voxel_m)) {
  index_.reserve(planes.size());
  for (std::uint32_t i = 0; i < planes.size(); ++i) {
    index_.emplace(CubeKey(planes[i].center, inverse_size_), i);
  }
}

bool PlaneIndex::Matches(const PlaneVoxel& moved, float distance) const {
  const Cube cube = CubeOf(moved.center, inverse_size_);
  for (int neighbor = 0; neighbor < 27; ++neighbor) {
    const Cube near{cube.x + neighbor % 3 - 1, cube.y + neighbor / 3 % 3 - 1,
                    cube.z + neighbor / 9 - 1};
    const auto found = index_.find(CubeKey(near));
    if (found == index_.end()) continue;
    const PlaneVoxel& other = planes_[found->second];
    const Eigen::Vector3f offset = moved.center - other.center;
    if (std::abs(moved.normal.dot(other.normal)) > kParallelCosine &&
        std::abs(offset.dot(other.normal)) < distance &&
        std::abs(offset.dot(moved.normal)) < distance) {
      return true;
    }
  }
  return false;
}

double PlaneIndex::Overlap(const std::vector<PlaneVoxel>& planes, const Pose& T_index_planes,
                           double distance_m) const {
  if (planes.empty()) return 0.0;
  const Eigen::Isometry3f transform = T_index_planes.cast<float>();
  std::size_t matches = 0;
  for (const PlaneVoxel& plane : planes) {
    const PlaneVoxel moved{transform * plane.center, transform.linear() * plane.normal,
                           plane.points};
    if (Matches(moved, static_cast<float>(distance_m))) ++matches;
  }
  return static_cast<double>(matches) / static_cast<double>(planes.size());
}

}  // namespace hv::loop
