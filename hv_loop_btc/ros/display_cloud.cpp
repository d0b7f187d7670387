#include "display_cloud.h"

#include <algorithm>
#include <utility>

#include "hv_core/cube_key.h"
#include "hv_ros/conversions.h"

namespace hv::loop {

DisplayCloud::DisplayCloud(double voxel_m, std::size_t max_points)
    : configured_voxel_m_(voxel_m), max_points_(max_points), voxel_m_(voxel_m) {}

void DisplayCloud::Update(const std::vector<GraphVertex>& vertices, const Loader& load) {
  if (HasMoved(vertices)) Clear();
  for (const GraphVertex& vertex : vertices) {
    if (added_.count(vertex.id) != 0) continue;
    const PointCloud cloud = load(vertex.id);
    for (const Point& point : Transformed(vertex.T_map_imu, cloud.points)) Add(point);
    added_[vertex.id] = vertex.T_map_imu;
  }
}

void DisplayCloud::Clear() {
  voxel_m_ = configured_voxel_m_;
  added_.clear();
  taken_.clear();
  points_.clear();
}

bool DisplayCloud::HasMoved(const std::vector<GraphVertex>& vertices) const {
  constexpr double kAngle = 0.01;  // [rad]
  const double distance = 0.5 * configured_voxel_m_;
  return std::any_of(vertices.begin(), vertices.end(), [&](const GraphVertex& vertex) {
    const auto added = added_.find(vertex.id);
    return added != added_.end() &&
           ((added->second.translation() - vertex.T_map_imu.translation()).norm() > distance ||
            RotationDistance(added->second, vertex.T_map_imu) > kAngle);
  });
}

void DisplayCloud::Add(const Point& point) {
  const auto inverse_size = static_cast<float>(1.0 / voxel_m_);
  const std::uint64_t key = CubeKey(Eigen::Vector3f(point.x, point.y, point.z), inverse_size);
  if (!taken_.insert(key).second) return;
  points_.push_back(point);
  while (points_.size() > max_points_) Coarsen();
}

void DisplayCloud::Coarsen() {
  voxel_m_ *= 2.0;
  const std::vector<Point> points = std::exchange(points_, {});
  taken_.clear();
  const auto inverse_size = static_cast<float>(1.0 / voxel_m_);
  for (const Point& point : points) {
    const std::uint64_t key = CubeKey(Eigen::Vector3f(point.x, point.y, point.z), inverse_size);
    if (taken_.insert(key).second) points_.push_back(point);
  }
}

}  // namespace hv::loop
