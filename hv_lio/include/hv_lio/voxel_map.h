#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_core/se3.h"
#include "hv_lio/plane_merger.h"
#include "hv_lio/scan_preprocessor.h"
#include "hv_lio/voxel.h"
#include "hv_lio/voxel_table.h"
#include "hv_lio/voxel_view.h"

namespace hv::lio {

struct VoxelMapConfig {
  double voxel_size_m = 1.0;
  int layers = 3;
  int capacity = 100000;
  int max_subdivisions = 150000;
  VoxelFitConfig fit;
  PlaneMergeConfig merge;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// The adaptive hybrid hash-voxel map (paper 3.1, Fig. 2-3): a hash table of fixed capacity of root
/// voxels in least-recently-used order; voxels that are dense and not planar are subdivided into
/// octants, neighbouring settled planes are merged. All memory is bounded by the configuration.
/// Const methods may run concurrently with each other, not with Insert or Clear.
class VoxelMap {
 public:
  explicit VoxelMap(const VoxelMapConfig& config);

  /// Adds a scan: cells in the IMU frame, moved by `T_odom_imu`.
  void Insert(const std::vector<SurfaceCell>& cells, const Pose& T_odom_imu);

  /// The surface at a point of odom: the coarsest plane that holds it, else the Gaussian of the
  /// finest voxel; nullptr when nothing is known there.
  const SurfaceFeature* Find(const Eigen::Vector3d& point) const;

  void Clear();

  std::size_t size() const { return table_.size(); }
  std::size_t capacity() const { return table_.capacity(); }
  std::size_t subdivisions() const { return blocks_in_use_; }
  std::size_t merged_planes() const { return merger_.size(); }
  std::size_t evictions() const { return evictions_; }
  bool Contains(const VoxelKey& key) const { return table_.Find(key) != kNoIndex; }
  VoxelKey KeyOf(const Eigen::Vector3d& point) const;

  /// At most `limit` voxels for visualisation, most recently touched first.
  std::vector<VoxelView> View(std::size_t limit) const;

 private:
  using Block = std::array<Voxel, 8>;

  /// One cell on its way into the map: odom frame, relative to its root voxel's centre.
  struct Entry {
    std::uint32_t root = kNoIndex;
    VoxelKey key;
    double count = 0.0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    double noise = 0.0;  ///< variance of the mean, averaged over directions [m^2]
  };

  /// A voxel that an entry goes into.
  struct Target {
    Voxel* voxel = nullptr;
    const Entry* entry = nullptr;
    Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< relative to the root's centre
  };

  std::vector<Entry> MakeEntries(const std::vector<SurfaceCell>& cells, const Pose& T_odom_imu);
  void FillLayer(const std::vector<Target>& targets, int layer);
  std::vector<Target> ChildrenOf(const std::vector<Target>& targets, int layer);
  void Accumulate(const Entry& entry, Voxel& voxel);
  void Contradict(const Entry& entry, Voxel& voxel);
  void Refit(const Target& target, int layer);
  void Subdivide(Voxel& voxel);
  void MergeWithNeighbors(std::uint32_t root);
  std::uint32_t TouchRoot(const VoxelKey& key);
  void Evict(std::uint32_t root);
  void ReleaseChildren(Voxel& voxel);
  Eigen::Vector3d RootCenter(std::uint32_t root) const;
  PlaneMerger::Candidate CandidateOf(std::uint32_t root) const;
  void AppendView(std::uint32_t root, std::vector<VoxelView>& views) const;

  VoxelMapConfig config_;
  VoxelTable table_;
  std::vector<Voxel> roots_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> free_blocks_;
  PlaneMerger merger_;
  std::size_t blocks_in_use_ = 0;
  std::size_t evictions_ = 0;
  std::uint32_t scan_number_ = 0;
  Eigen::Vector3f sensor_position_ = Eigen::Vector3f::Zero();
};

}  // namespace hv::lio
