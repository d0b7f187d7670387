#include "hv_core/keyframe_store.h"

#include <cstdio>
#include <filesystem>

#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "hv_core/map_folder.h"
#include "map_manifest.h"

namespace hv {

namespace fs = std::filesystem;

void KeyframeStoreConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("leaf_m", leaf_m, "edge of the cubes that saved key scans are thinned to [m]");
  visitor.Field("keep", keep, "keep the working files of key scans after the run");
}

void KeyframeStoreConfig::Validate(ConfigProblems& problems) const {
  problems.Require(leaf_m >= 0.01 && leaf_m <= 2.0, "leaf_m", "must be between 0.01 and 2");
}

KeyframeStore::KeyframeStore(const std::string& folder, const KeyframeStoreConfig& config,
                             const Eigen::Vector3d& lidar_in_imu)
    : folder_(folder), config_(config), lidar_in_imu_(lidar_in_imu.cast<float>()) {
  std::error_code error;
  fs::create_directories(fs::path(PathOf(0)).parent_path(), error);
  if (error) throw InputError(folder_ + ": cannot be created (" + error.message() + ")");
  RemoveLeftovers();
}

KeyframeStore::~KeyframeStore() {
  if (config_.keep) return;
  for (const std::uint32_t id : ids_) std::remove(PathOf(id).c_str());
  std::error_code ignored;
  fs::remove(fs::path(PathOf(0)).parent_path(), ignored);
  fs::remove(folder_, ignored);
}

void KeyframeStore::RemoveLeftovers() const {
  std::error_code ignored;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(fs::path(PathOf(0)).parent_path(), ignored)) {
    std::uint32_t id = 0;
    const std::string name = "keyframes/" + entry.path().filename().string();
    if (ParseKeyframeName(name, id)) fs::remove(entry.path(), ignored);
  }
}

void KeyframeStore::SetLidarInImu(const Eigen::Vector3d& lidar_in_imu) {
  const std::lock_guard<std::mutex> lock(mutex_);
  lidar_in_imu_ = lidar_in_imu.cast<float>();
}

void KeyframeStore::Append(const Keyframe& keyframe) {
  RequireNew(keyframe.id);
  Eigen::Vector3f lidar_in_imu;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    lidar_in_imu = lidar_in_imu_;
  }
  WritePcd(PathOf(keyframe.id), ThinPoints(keyframe.points, config_.leaf_m),
           PcdEncoding::kCompressed, lidar_in_imu);
  Insert(keyframe.id);
}

void KeyframeStore::Adopt(std::uint32_t id, const std::string& pcd_path) {
  RequireNew(id);
  LinkOrCopy(pcd_path, PathOf(id));
  Insert(id);
}

void KeyframeStore::RequireNew(std::uint32_t id) const {
  if (Contains(id)) throw InputError("keyframe " + std::to_string(id) + " comes a second time");
}

void KeyframeStore::Insert(std::uint32_t id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ids_.insert(id);
}

PointCloud KeyframeStore::Load(std::uint32_t id) const {
  if (!Contains(id)) throw InputError("there is no keyframe " + std::to_string(id));
  return ReadPointCloud(PathOf(id));
}

bool KeyframeStore::Contains(std::uint32_t id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return ids_.count(id) != 0;
}

std::vector<std::uint32_t> KeyframeStore::Ids() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {ids_.begin(), ids_.end()};
}

std::string KeyframeStore::PathOf(std::uint32_t id) const {
  return folder_ + "/" + KeyframeFileName(id);
}

}  // namespace hv
