#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <unordered_set>
#include <vector>

#include "hv_core/point_cloud_file.h"
#include "hv_core/pose_graph_data.h"

namespace hv::loop {

/// The corrected map as points to look at: one a cube, bounded in number. Only new keyframes are
/// added, until earlier ones move; then it is made anew. Not thread-safe.
class DisplayCloud {
 public:
  /// Points of a keyframe in the frame of its pose. May throw.
  using Loader = std::function<PointCloud(std::uint32_t id)>;

  /// `voxel_m`: edge of the cubes; doubled whenever there are more than `max_points`.
  DisplayCloud(double voxel_m, std::size_t max_points);

  /// Brings the cloud up to date with `vertices`; what `load` throws leaves it incomplete.
  void Update(const std::vector<GraphVertex>& vertices, const Loader& load);

  /// In the map frame.
  const std::vector<Point>& points() const { return points_; }

 private:
  void Clear();
  bool HasMoved(const std::vector<GraphVertex>& vertices) const;
  void Add(const Point& point);
  void Coarsen();

  const double configured_voxel_m_;
  const std::size_t max_points_;
  double voxel_m_;
  std::map<std::uint32_t, Pose> added_;  ///< keyframes that are in, with the poses used
  std::unordered_set<std::uint64_t> taken_;
  std::vector<Point> points_;
};

}  // namespace hv::loop
