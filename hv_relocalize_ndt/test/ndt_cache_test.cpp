#include "hv_relocalize_ndt/ndt_cache.h"

#include <filesystem>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "known_hall.h"

namespace hv::relocalize {
namespace {

std::vector<NdtLevel> Levels() {
  std::mt19937 random(3);
  const std::vector<Eigen::Vector3f> cloud = CloudOf(loop::Hall(7), random);
  std::vector<NdtLevel> levels;
  levels.emplace_back(3.0, cloud);
  levels.emplace_back(0.5, cloud);
  return levels;
}

TEST(NdtCacheTest, LevelsComeBackAsTheyWere) {
  const std::vector<NdtLevel> levels = Levels();
  const auto read = ParseLevels(SerializeLevels(levels, "key"), "key", "test");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), levels.size());
  for (std::size_t k = 0; k < levels.size(); ++k) {
    EXPECT_EQ((*read)[k].resolution_m(), levels[k].resolution_m());
    ASSERT_EQ((*read)[k].voxels().size(), levels[k].voxels().size());
    for (std::size_t i = 0; i < levels[k].voxels().size(); ++i) {
      const NdtVoxel& a = levels[k].voxels()[i];
      const NdtVoxel& b = (*read)[k].voxels()[i];
      EXPECT_EQ(a.mean, b.mean);
      EXPECT_LT((a.information - b.information).norm(), 1e-5F * a.information.norm());
      EXPECT_LE((a.held - b.held).norm(), 1e-5F * a.held.norm());
      EXPECT_EQ(a.normal, b.normal);
      EXPECT_EQ(a.facing, b.facing);
      EXPECT_EQ(a.flatness, b.flatness);
      EXPECT_EQ(a.points, b.points);
      const NdtLevel::Neighbors* around = (*read)[k].Around(b.mean);
      ASSERT_NE(around, nullptr);
      EXPECT_EQ(around->count, levels[k].Around(a.mean)->count);
    }
  }
}

TEST(NdtCacheTest, AnotherKeyIsAsGoodAsNone) {
  EXPECT_FALSE(ParseLevels(SerializeLevels(Levels(), "key"), "other", "test"));
}

TEST(NdtCacheTest, DamageNeverPasses) {
  const std::string whole = SerializeLevels(Levels(), "key");
  std::mt19937 random(4);
  for (int i = 0; i < 300; ++i) {
    std::string bytes = whole;
    if (i % 2 == 0) {
      bytes.resize(random() % whole.size());
    } else {
      bytes[random() % whole.size()] ^= static_cast<char>(1U + random() % 255U);
    }
    try {
      EXPECT_FALSE(ParseLevels(bytes, "key", "test"));
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("test: ", 0), 0U);
    }
  }
}

TEST(NdtCacheTest, AFileThatIsMissingOrDamagedIsMadeAnew) {
  const std::string path = testing::TempDir() + "ndt_cache_test.bin";
  std::filesystem::remove(path);
  EXPECT_FALSE(ReadLevels(path, "key"));
  ASSERT_TRUE(WriteLevels(path, Levels(), "key"));
  EXPECT_TRUE(ReadLevels(path, "key"));
  std::filesystem::resize_file(path, 1000);
  EXPECT_FALSE(ReadLevels(path, "key"));
  EXPECT_FALSE(WriteLevels("/nowhere/at/all.bin", Levels(), "key"));
}

}  // namespace
}  // namespace hv::relocalize
