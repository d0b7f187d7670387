#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hv_lio/voxel.h"

namespace hv::lio {

/// Index of a root voxel (paper Eq. 1): floor(p / r) on each axis.
struct VoxelKey {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;

  friend bool operator==(const VoxelKey& a, const VoxelKey& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
};

/// Spatial hash (paper Eq. 2), in unsigned arithmetic.
std::uint64_t HashOf(const VoxelKey& key);

/// Hash table of fixed capacity from voxel keys to slot numbers 0..capacity-1, with its slots in
/// least-recently-used order (paper Fig. 3). The full key is kept, so two places that share a hash
/// never share a slot. All memory is taken at construction.
class VoxelTable {
 public:
  explicit VoxelTable(std::size_t capacity);

  /// Slot of `key`, kNoIndex when absent. Leaves the order as it is.
  std::uint32_t Find(const VoxelKey& key) const;

  /// Takes a free slot for `key`, which must be absent, and makes it the most recent. The table
  /// must not be full.
  std::uint32_t Insert(const VoxelKey& key);

  /// Makes a slot in use the most recent.
  void Touch(std::uint32_t slot);

  /// Frees a slot in use.
  void Erase(std::uint32_t slot);

  void Clear();

  std::size_t size() const { return size_; }
  std::size_t capacity() const { return slots_.size(); }
  bool full() const { return size_ == slots_.size(); }
  const VoxelKey& key(std::uint32_t slot) const { return slots_[slot].key; }

  /// Most and least recently used slot, kNoIndex when empty, and the next older one.
  std::uint32_t newest() const { return newest_; }
  std::uint32_t oldest() const { return oldest_; }
  std::uint32_t older(std::uint32_t slot) const { return slots_[slot].older; }

 private:
  struct Slot {
    VoxelKey key;
    std::uint32_t chain = kNoIndex;  ///< next slot of the same bucket, or of the free list
    std::uint32_t newer = kNoIndex;
    std::uint32_t older = kNoIndex;
  };

  std::uint32_t& BucketOf(const VoxelKey& key) { return buckets_[HashOf(key) % buckets_.size()]; }
  void LinkNewest(std::uint32_t slot);
  void Unlink(std::uint32_t slot);

  std::vector<Slot> slots_;
  std::vector<std::uint32_t> buckets_;
  std::uint32_t free_ = kNoIndex;
  std::uint32_t newest_ = kNoIndex;
  std::uint32_t oldest_ = kNoIndex;
  std::size_t size_ = 0;
};

}  // namespace hv::lio
