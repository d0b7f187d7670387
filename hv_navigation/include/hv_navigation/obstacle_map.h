#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/scan.h"
#include "hv_core/se3.h"
#include "hv_navigation/mapping_config.h"

namespace hv::navigation {

enum class Sensor { kLidar, kDepthCamera };

/// What became of the points of a scan.
struct InsertReport {
  std::size_t points = 0;
  std::size_t invalid = 0;     ///< not finite, or beyond any map
  std::size_t too_near = 0;    ///< of the robot itself
  std::size_t marked = 0;      ///< returns that mark a voxel
  std::size_t only_clear = 0;  ///< too far away to mark anything
  bool refused = false;        ///< the pose is not finite, or the sensor outside of the region
};

/// A leaf of the map: a voxel, or a cube of voxels that are alike.
struct VoxelView {
  Eigen::Vector3i low = Eigen::Vector3i::Zero();  ///< lower corner, in voxels from the origin
  int side = 1;                                   ///< in voxels
  bool occupied = false;                          ///< else free
  float low_m = 0.0F;   ///< z of the lowest returns, of a single occupied voxel [m]
  float high_m = 0.0F;  ///< and of the highest [m]
};

/// What stands around the robot, in the frame of odometry: an octree of occupied and free voxels
/// (OctoMap), fed with the scans of a LiDAR and the points of a depth camera.
///
/// A voxel changes once a scan: a return in it wins over rays that pass. The map reaches a set
/// distance from the robot; what falls behind is dropped, so that memory is bounded.
///
/// Both sensors share the voxels. What the camera saw low in front of the robot is nothing that the
/// LiDAR could see, so that rays of the LiDAR over it must not clear it: a voxel remembers the
/// heights of its returns, and only rays at these heights contradict them. So it stays until the
/// camera sees through it or the robot is gone, while a person who leaves is cleared by any ray.
///
/// Deterministic. Not thread-safe; const methods may run concurrently.
class ObstacleMap {
 public:
  enum class State { kUnknown, kFree, kOccupied };

  explicit ObstacleMap(const ObstacleMapConfig& config);
  ~ObstacleMap();
  ObstacleMap(ObstacleMap&&) noexcept;
  ObstacleMap& operator=(ObstacleMap&&) noexcept;

  /// Moves the region so that the robot [m] is in its middle, to the next eight voxels. A position
  /// that is not finite or out of reach changes nothing.
  void MoveTo(const Eigen::Vector3d& robot);

  /// Forgets all but what is nearer to a position than that along each axis, to the next eight
  /// voxels.
  void KeepNear(const Eigen::Vector3d& position, double distance_m);

  /// Takes the points of one scan, free of distortion, in the frame of the sensor. The sensor has
  /// to be in the region, see MoveTo().
  InsertReport Insert(Sensor sensor, const std::vector<Point>& points, const Pose& T_odom_sensor);

  State StateAt(const Eigen::Vector3d& position) const;

  /// Visits the leaves that touch the box of voxels from `low` to below `high`, always in the same
  /// order.
  void Visit(const Eigen::Vector3i& low, const Eigen::Vector3i& high,
             const std::function<void(const VoxelView&)>& visit) const;

  double voxel_m() const { return config_.voxel_m; }
  Eigen::Vector3i VoxelOf(const Eigen::Vector3d& position) const;
  std::size_t node_count() const;

  /// Writes an octree as octomap's viewers read it. Throws InputError when it cannot be written.
  void WriteBinary(const std::string& path) const;

 private:
  struct Impl;
  ObstacleMapConfig config_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hv::navigation
