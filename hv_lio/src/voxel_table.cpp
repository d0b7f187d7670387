#include "hv_lio/voxel_table.h"

namespace hv::lio {

std::uint64_t HashOf(const VoxelKey& key) {
  const auto wide = [](std::int32_t value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
  };
  return (wide(key.x) * 73856093U) ^ (wide(key.y) * 19349663U) ^ (wide(key.z) * 83492791U);
}

VoxelTable::VoxelTable(std::size_t capacity)
    : slots_(capacity), buckets_(capacity, kNoIndex) {
  Clear();
}

void VoxelTable::Clear() {
  buckets_.assign(buckets_.size(), kNoIndex);
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    slots_[i] = Slot();
    slots_[i].chain = i + 1 < slots_.size() ? static_cast<std::uint32_t>(i + 1) : kNoIndex;
  }
  free_ = slots_.empty() ? kNoIndex : 0;
  newest_ = kNoIndex;
  oldest_ = kNoIndex;
  size_ = 0;
}

std::uint32_t VoxelTable::Find(const VoxelKey& key) const {
  std::uint32_t slot = buckets_[HashOf(key) % buckets_.size()];
  while (slot != kNoIndex && !(slots_[slot].key == key)) slot = slots_[slot].chain;
  return slot;
}

std::uint32_t VoxelTable::Insert(const VoxelKey& key) {
  const std::uint32_t slot = free_;
  free_ = slots_[slot].chain;
  std::uint32_t& bucket = BucketOf(key);
  slots_[slot].key = key;
  slots_[slot].chain = bucket;
  bucket = slot;
  LinkNewest(slot);
  ++size_;
  return slot;
}

void VoxelTable::Touch(std::uint32_t slot) {
  if (slot == newest_) return;
  Unlink(slot);
  LinkNewest(slot);
}

void VoxelTable::Erase(std::uint32_t slot) {
  std::uint32_t* link = &BucketOf(slots_[slot].key);
  while (*link != slot) link = &slots_[*link].chain;
  *link = slots_[slot].chain;
  Unlink(slot);
  slots_[slot].chain = free_;
  free_ = slot;
  --size_;
}

void VoxelTable::LinkNewest(std::uint32_t slot) {
  slots_[slot].newer = kNoIndex;
  slots_[slot].older = newest_;
  if (newest_ != kNoIndex) slots_[newest_].newer = slot;
  newest_ = slot;
  if (oldest_ == kNoIndex) oldest_ = slot;
}

void VoxelTable::Unlink(std::uint32_t slot) {
  const Slot& taken = slots_[slot];
  if (taken.newer != kNoIndex) slots_[taken.newer].older = taken.older;
  if (taken.older != kNoIndex) slots_[taken.older].newer = taken.newer;
  if (newest_ == slot) newest_ = taken.older;
  if (oldest_ == slot) oldest_ = taken.newer;
}

}  // namespace hv::lio
