#include "hv_loop_btc/submap_file.h"

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "town.h"

namespace hv::loop {
namespace {

StoredSubmaps Example() {
  const Town town(3);
  std::mt19937 random(1);
  BtcExtractor extractor{BtcConfig()};
  StoredSubmaps submaps;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Submap submap = town.SubmapAt(10 * i, SensorPose(i, 0.0, 0.4 * i), random);
    submaps.records.push_back(
        {submap.keyframe,
         submap.stamp,
         {{submap.keyframe, Pose::Identity()}, {submap.keyframe + 1, SensorPose(0.5, 0.1, 0.2)}},
         2.5 * i});
    submaps.descriptors.push_back(extractor.Extract(submap));
  }
  submaps.scale = extractor.scale_name();
  return submaps;
}

TEST(SubmapFileTest, RoundTripKeepsEverything) {
  const StoredSubmaps before = Example();
  const std::string bytes = Serialize(before);
  const StoredSubmaps after = ParseSubmaps(bytes, "test");
  ASSERT_EQ(after.records.size(), before.records.size());
  EXPECT_EQ(after.scale, before.scale);
  EXPECT_EQ(after.records[2].stamp, before.records[2].stamp);
  EXPECT_LT((after.records[1].members[1].T_submap_keyframe.matrix() -
             before.records[1].members[1].T_submap_keyframe.matrix())
                .norm(),
            1e-12);
  EXPECT_EQ(after.descriptors[1].triangles.size(), before.descriptors[1].triangles.size());
  EXPECT_EQ(Serialize(after).size(), bytes.size());
}

TEST(SubmapFileTest, DamageIsRefusedOrHarmless) {
  const std::string bytes = Serialize(Example());
  std::mt19937 random(77);
  std::uniform_int_distribution<std::size_t> place(0, bytes.size() - 1);
  std::uniform_int_distribution<int> byte(0, 255);
  int refused = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string damaged = bytes;
    if (round % 2 == 0) {
      damaged.resize(place(random));
    } else {
      for (int i = 0; i < 4; ++i) damaged[place(random)] = static_cast<char>(byte(random));
    }
    try {
      const StoredSubmaps read = ParseSubmaps(damaged, "damaged");
      EXPECT_EQ(read.records.size(), read.descriptors.size());
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("damaged: ", 0), 0U);
      ++refused;
    }
  }
  EXPECT_GT(refused, 2000);
}

}  // namespace
}  // namespace hv::loop
