#include "hv_lio/voxel_table.h"

#include <random>

#include <gtest/gtest.h>

namespace hv::lio {
namespace {

TEST(HashTest, IsThePapersFormulaInUnsignedArithmetic) {
  EXPECT_EQ(HashOf({0, 0, 0}), 0U);
  EXPECT_EQ(HashOf({1, 0, 0}), 73856093U);
  EXPECT_EQ(HashOf({1, 2, 3}), 73856093ULL ^ (2ULL * 19349663ULL) ^ (3ULL * 83492791ULL));
  EXPECT_EQ(HashOf({-1, 0, 0}), 0ULL - 73856093ULL);
}

TEST(VoxelTableTest, CollidingKeysKeepTheirOwnSlots) {
  VoxelTable table(4);
  std::vector<VoxelKey> same_bucket;
  for (int x = 0; same_bucket.size() < 4; ++x) {
    if (HashOf({x, -x, 7}) % 4 == 1) same_bucket.push_back({x, -x, 7});
  }
  std::vector<std::uint32_t> slots;
  for (const VoxelKey& key : same_bucket) slots.push_back(table.Insert(key));
  for (std::size_t i = 0; i < slots.size(); ++i) EXPECT_EQ(table.Find(same_bucket[i]), slots[i]);
  table.Erase(slots[1]);
  EXPECT_EQ(table.Find(same_bucket[1]), kNoIndex);
  EXPECT_EQ(table.Find(same_bucket[0]), slots[0]);
  EXPECT_EQ(table.Find(same_bucket[2]), slots[2]);
  EXPECT_EQ(table.Find(same_bucket[3]), slots[3]);
}

TEST(VoxelTableTest, OrderIsLeastRecentlyUsed) {
  VoxelTable table(3);
  const std::uint32_t a = table.Insert({1, 0, 0});
  const std::uint32_t b = table.Insert({2, 0, 0});
  const std::uint32_t c = table.Insert({3, 0, 0});
  EXPECT_TRUE(table.full());
  EXPECT_EQ(table.oldest(), a);
  table.Touch(a);
  EXPECT_EQ(table.oldest(), b);
  EXPECT_EQ(table.newest(), a);
  EXPECT_EQ(table.older(a), c);
  table.Erase(table.oldest());
  EXPECT_EQ(table.oldest(), c);
  EXPECT_EQ(table.size(), 2U);
}

/// Compares with a plain list of keys, newest first, under random operations.
TEST(VoxelTableTest, AgreesWithAReferenceUnderRandomOperations) {
  std::mt19937 random(1);
  VoxelTable table(50);
  std::vector<VoxelKey> reference;
  for (int i = 0; i < 20000; ++i) {
    const VoxelKey key{static_cast<int>(random() % 5) - 2, static_cast<int>(random() % 5) - 2,
                       static_cast<int>(random() % 5) - 2};
    const auto known = std::find(reference.begin(), reference.end(), key);
    const std::uint32_t slot = table.Find(key);
    ASSERT_EQ(slot != kNoIndex, known != reference.end());
    if (known != reference.end()) {
      table.Touch(slot);
      reference.erase(known);
    } else {
      if (table.full()) {
        ASSERT_EQ(table.key(table.oldest()), reference.back());
        table.Erase(table.oldest());
        reference.pop_back();
      }
      table.Insert(key);
    }
    reference.insert(reference.begin(), key);
    ASSERT_EQ(table.key(table.newest()), reference.front());
    ASSERT_EQ(table.key(table.oldest()), reference.back());
    ASSERT_EQ(table.size(), reference.size());
  }
}

TEST(VoxelTableTest, ClearLeavesAnEmptyTableOfTheSameCapacity) {
  VoxelTable table(2);
  table.Insert({1, 1, 1});
  table.Clear();
  EXPECT_EQ(table.size(), 0U);
  EXPECT_EQ(table.Find({1, 1, 1}), kNoIndex);
  table.Insert({1, 1, 1});
  table.Insert({2, 1, 1});
  EXPECT_TRUE(table.full());
}

}  // namespace
}  // namespace hv::lio
