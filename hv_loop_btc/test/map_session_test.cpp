#include "hv_loop_btc/map_session.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "hv_core/map_folder.h"
#include "hv_loop_btc/map_saver.h"
#include "town.h"

namespace hv::loop {
namespace {

namespace fs = std::filesystem;

constexpr int kPerRound = 60;
constexpr double kRadius = 8.0;

Pose TruthAt(int i) {
  const double angle = 2.0 * M_PI * i / kPerRound;
  return SensorPose(kRadius * std::cos(angle), kRadius * std::sin(angle), angle + M_PI / 2.0);
}

/// Continues a map of a circle through a town with a second session whose odometry starts
/// elsewhere on the circle.
class MapSessionTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("hv_map_session_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  Keyframe Make(std::uint32_t id, std::uint32_t segment, int place, const Pose& T_town_odom) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.segment = segment;
    keyframe.stamp = Time::FromSeconds(100.0 + id);
    keyframe.T_odom_imu = T_town_odom.inverse() * TruthAt(place);
    keyframe.covariance = 1e-6 * Matrix6d::Identity();
    for (const Eigen::Vector3f& p : town_.Seen(TruthAt(place), 12.0, 8.0, random_)) {
      Point point;
      point.x = p.x();
      point.y = p.y();
      point.z = p.z();
      keyframe.points.push_back(point);
    }
    return keyframe;
  }

  std::string SaveFirstSession() {
    KeyframeStore store(folder_ / "work1", {}, Eigen::Vector3d::Zero());
    LoopCloser closer(LoopConfig(), store);
    for (int i = 0; i < kPerRound + 20; ++i) {
      closer.Add(Make(static_cast<std::uint32_t>(i), 0, i, Pose::Identity()));
    }
    closer.Finish();
    const std::string path = folder_ / "map";
    MapSaver({}, "").Save(SnapshotOf(closer), store, path, MapParts::kEssential);
    return path;
  }

  const Town town_{21, 25};
  std::mt19937 random_{6};
  fs::path folder_;
};

TEST_F(MapSessionTest, ASessionFindsItsPlaceInAnOlderMapAndIsSavedWithIt) {
  const std::string path = SaveFirstSession();
  KeyframeStore store(folder_ / "work2", {}, Eigen::Vector3d::Zero());
  LoopCloser closer(LoopConfig(), store);
  const SessionStart start = ContinueMap(path, store, closer);
  EXPECT_EQ(start.keyframe, 80U);
  EXPECT_EQ(start.segment, 1U);
  EXPECT_FALSE(closer.Joined());

  constexpr int kFirstPlace = 25;
  const Pose T_town_odom = TruthAt(kFirstPlace);  // odom starts level, at the sensor
  for (int i = 0; i < 50; ++i) {
    EXPECT_TRUE(closer.Joined() || closer.T_map_odom().isApprox(Pose::Identity(), 0.0));
    if (!closer.Joined()) {
      EXPECT_EQ(closer.PlacedVertices().size(), 80U);
    }
    closer.Add(Make(start.keyframe + static_cast<std::uint32_t>(i), start.segment, kFirstPlace + i,
                    T_town_odom));
  }
  closer.Finish();
  ASSERT_TRUE(closer.Joined());
  EXPECT_LT((closer.T_map_odom().translation() - T_town_odom.translation()).norm(), 0.1);
  EXPECT_LT(RotationDistance(closer.T_map_odom(), T_town_odom), 0.02);
  for (std::uint32_t i = 0; i < 50; ++i) {
    const Pose truth = TruthAt(kFirstPlace + static_cast<int>(i));
    EXPECT_LT((closer.graph().pose(80 + i).translation() - truth.translation()).norm(), 0.15);
  }

  // Over the map that was continued.
  MapSaver({}, "").Save(SnapshotOf(closer), store, path);
  const MapFolder saved = MapFolder::Open(path);
  saved.Verify();
  EXPECT_EQ(saved.KeyframeIds().size(), 130U);
  EXPECT_GT(saved.manifest().cloud_points, 1000U);
}

TEST_F(MapSessionTest, ASessionThatNeverJoinsIsKeptButNotSeen) {
  const std::string path = SaveFirstSession();
  KeyframeStore store(folder_ / "work2", {}, Eigen::Vector3d::Zero());
  LoopCloser closer(LoopConfig(), store);
  const SessionStart start = ContinueMap(path, store, closer);
  closer.Add(Make(start.keyframe, start.segment, 3, TruthAt(3)));
  closer.Finish();
  const MapSnapshot snapshot = SnapshotOf(closer);
  EXPECT_EQ(snapshot.graph.vertices.size(), 81U);
  EXPECT_EQ(snapshot.placed.size(), 80U);
}

TEST_F(MapSessionTest, DamageIsNamed) {
  const std::string path = SaveFirstSession();
  for (const char* name : {"graph.g2o", "descriptors.bin", "keyframes/000007.pcd"}) {
    const std::string file = path + "/" + name;
    fs::copy_file(file, folder_ / "backup", fs::copy_options::overwrite_existing);
    fs::remove(file);  // it may share its bytes with the backup of a store
    fs::copy_file(folder_ / "backup", file);
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(200);
    stream.put('~');
    stream.close();
    KeyframeStore store(folder_ / "work2", {}, Eigen::Vector3d::Zero());
    LoopCloser closer(LoopConfig(), store);
    try {
      ContinueMap(path, store, closer);
      FAIL() << name << " was accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
    fs::copy_file(folder_ / "backup", file, fs::copy_options::overwrite_existing);
  }
  KeyframeStore store(folder_ / "work2", {}, Eigen::Vector3d::Zero());
  LoopCloser closer(LoopConfig(), store);
  EXPECT_THROW(ContinueMap(folder_ / "nowhere", store, closer), InputError);
}

}  // namespace
}  // namespace hv::loop
