#include "hv_core/keyframe_store.h"

#include <fstream>

#include "small_map.h"

namespace hv {
namespace {

Keyframe KeyframeWith(std::uint32_t id, std::vector<Point> points) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.points = std::move(points);
  return keyframe;
}

TEST(KeyframeStore, GivesBackThinnedPointsAndTheSensorPosition) {
  const TemporaryFolder folder;
  const KeyframeStoreConfig config;
  KeyframeStore store(folder / "work", config, Eigen::Vector3d(0.5, 0.0, -0.25));
  const std::vector<Point> points = RandomPoints(500, 1);
  store.Append(KeyframeWith(4, points));
  store.Append(KeyframeWith(2, {}));
  EXPECT_EQ(store.Ids(), (std::vector<std::uint32_t>{2, 4}));
  const PointCloud cloud = store.Load(4);
  const std::vector<Point> expected = ThinPoints(points, config.leaf_m);
  ASSERT_EQ(cloud.points.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(cloud.points[i].x, expected[i].x);
    EXPECT_EQ(cloud.points[i].intensity, expected[i].intensity);
  }
  EXPECT_EQ(cloud.sensor_origin, Eigen::Vector3f(0.5F, 0.0F, -0.25F));
  EXPECT_TRUE(store.Load(2).points.empty());
}

TEST(KeyframeStore, UnknownAndRepeatedIdsAreErrors) {
  const TemporaryFolder folder;
  KeyframeStore store(folder / "work", {}, Eigen::Vector3d::Zero());
  store.Append(KeyframeWith(0, {}));
  EXPECT_NE(ErrorOf([&] { store.Append(KeyframeWith(0, {})); }), "");
  EXPECT_NE(ErrorOf([&] { store.Load(1); }), "");
  EXPECT_NE(ErrorOf([] { KeyframeStore("/proc/none", {}, Eigen::Vector3d::Zero()); }), "");
}

TEST(KeyframeStore, RemovesItsFolderUnlessToBeKept) {
  const TemporaryFolder folder;
  for (const bool keep : {false, true}) {
    KeyframeStoreConfig config;
    config.keep = keep;
    {
      KeyframeStore store(folder / "work", config, Eigen::Vector3d::Zero());
      store.Append(KeyframeWith(3, RandomPoints(5, 2)));
    }
    EXPECT_EQ(std::filesystem::exists(folder / "work/keyframes/000003.pcd"), keep);
    EXPECT_EQ(std::filesystem::exists(folder / "work"), keep);
  }
}

TEST(KeyframeStore, StartsEmptyWhereAnEarlierRunDied) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "work/keyframes");
  std::ofstream(folder / "work/keyframes/000007.pcd") << "leftover";
  std::ofstream(folder / "work/keyframes/notes.txt") << "mine";
  {
    const KeyframeStore store(folder / "work", {}, Eigen::Vector3d::Zero());
    EXPECT_TRUE(store.Ids().empty());
    EXPECT_FALSE(std::filesystem::exists(store.PathOf(7)));
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "work/keyframes/notes.txt"));
}

}  // namespace
}  // namespace hv
