#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "hv_core/config.h"
#include "hv_core/keyframe.h"
#include "hv_core/point_cloud_file.h"

namespace hv {

struct KeyframeStoreConfig {
  double leaf_m = 0.1;
  bool keep = false;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Keeps the clouds of keyframes on disk, one thinned PCD each, so that memory does not grow with
/// them: only ids are held. Written files are never changed, so MapWriter can link them into a map.
/// All methods are thread-safe and throw InputError when the disk fails.
class KeyframeStore {
 public:
  /// Creates `folder`; keyframe files that an earlier run left there are removed. `lidar_in_imu` is
  /// the position of the LiDAR in the IMU frame [m], saved as the viewpoint of each cloud.
  KeyframeStore(const std::string& folder, const KeyframeStoreConfig& config,
                const Eigen::Vector3d& lidar_in_imu);
  /// Removes the files, and the folder if nothing else is in it, unless they are to be kept.
  ~KeyframeStore();
  KeyframeStore(const KeyframeStore&) = delete;
  KeyframeStore& operator=(const KeyframeStore&) = delete;

  /// Position of the LiDAR in the IMU frame [m] for keyframes appended from now on.
  void SetLidarInImu(const Eigen::Vector3d& lidar_in_imu);

  /// Thins and writes the points of `keyframe`. Throws InputError when its id is already there.
  void Append(const Keyframe& keyframe);

  /// Takes over the cloud of a keyframe of another session by a hard link, or a copy on another
  /// file system. Throws InputError when its id is already there.
  void Adopt(std::uint32_t id, const std::string& pcd_path);

  /// Points in the IMU frame, with firing intensity. Throws InputError for an unknown id.
  PointCloud Load(std::uint32_t id) const;

  bool Contains(std::uint32_t id) const;
  std::vector<std::uint32_t> Ids() const;  ///< ascending
  std::string PathOf(std::uint32_t id) const;

 private:
  void RemoveLeftovers() const;
  void RequireNew(std::uint32_t id) const;
  void Insert(std::uint32_t id);

  const std::string folder_;
  const KeyframeStoreConfig config_;
  mutable std::mutex mutex_;  // guards everything below
  Eigen::Vector3f lidar_in_imu_;
  std::set<std::uint32_t> ids_;
};

}  // namespace hv
