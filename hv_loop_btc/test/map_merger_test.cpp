#include "hv_loop_btc/map_merger.h"

#include <filesystem>
#include <fstream>
#include <memory>

#include <gtest/gtest.h>
#include <unistd.h>

#include "hall.h"
#include "hv_core/error.h"
#include "hv_core/map_writer.h"

namespace hv::loop {
namespace {

namespace fs = std::filesystem;

/// Enough for a hall.
MapMergerConfig FastConfig() {
  MapMergerConfig config;
  config.loop.detector.max_alignments = 3;
  config.loop.registration.max_iterations = 15;
  return config;
}

/// One walk on a circle in a hall, with an odometry that starts somewhere and drifts.
struct Walk {
  unsigned hall = 21;
  double radius_m = 4.6;
  double start_rad = 0.0;
  double direction = 1.0;  ///< 1: counter-clockwise
  Pose T_odom_hall = Pose::Identity();
  double drift_rad_per_step = 0.0;
  unsigned noise_seed = 6;

  static constexpr int kKeyframes = 50;

  Pose TruthAt(int i) const {
    const double angle = start_rad + direction * 2.0 * M_PI * i / kKeyframes;
    return MakePose(RotationFromRpy(0.0, 0.0, angle + direction * M_PI / 2.0),
                    {radius_m * std::cos(angle), radius_m * std::sin(angle), 1.2});
  }

  /// Writes the map of this walk.
  void Save(const std::string& folder) const {
    KeyframeStore store(folder + ".store", KeyframeStoreConfig(), Eigen::Vector3d::Zero());
    LoopCloser closer(FastConfig().loop, store);
    const Hall place(hall);
    std::mt19937 random(noise_seed);
    Keyframe keyframe;
    keyframe.covariance = 1e-6 * Matrix6d::Identity();
    keyframe.T_odom_imu = T_odom_hall * TruthAt(0);
    for (int i = 0; i < kKeyframes; ++i) {
      if (i > 0) {
        const Pose error =
            MakePose(RotationFromRpy(0, 0, drift_rad_per_step), Eigen::Vector3d::Zero());
        keyframe.T_odom_imu = keyframe.T_odom_imu * TruthAt(i - 1).inverse() * TruthAt(i) * error;
      }
      keyframe.id = static_cast<std::uint32_t>(i);
      keyframe.stamp = Time::FromSeconds(100.0 + i);
      keyframe.points = place.Scan(TruthAt(i), random);
      closer.Add(keyframe);
    }
    closer.Finish();
    MapWriter writer(folder);
    for (const GraphVertex& vertex : closer.graph().Poses()) {
      writer.AddKeyframe(vertex.id, store.PathOf(vertex.id));
    }
    writer.AddGraph(closer.graph().ToData());
    writer.AddDescriptors(closer.SerializedSubmaps());
    writer.Commit("");
  }
};

Walk Elsewhere() {
  Walk walk;
  walk.radius_m = 4.0;
  walk.start_rad = 2.0;
  walk.direction = -1.0;
  walk.T_odom_hall = MakePose(RotationFromRpy(0.0, 0.0, 1.1), {30.0, -12.0, 0.7});
  walk.drift_rad_per_step = 0.0002;
  walk.noise_seed = 9;
  return walk;
}

class MapMergerTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    root_ = fs::temp_directory_path() / ("hv_map_merger_test_" + std::to_string(getpid()));
    Walk().Save(Path("first"));
    Elsewhere().Save(Path("second"));
    Walk other;
    other.hall = 77;
    other.Save(Path("other_hall"));
  }
  static void TearDownTestSuite() { fs::remove_all(root_); }
  void TearDown() override { fs::remove_all(Path("joined")); }

  static std::string Path(const std::string& name) { return (root_ / name).string(); }

  static MergedMap Merge(const std::vector<std::string>& names) {
    std::vector<MapFolder> maps;
    for (const std::string& name : names) maps.push_back(MapFolder::Open(Path(name)));
    return MapMerger(FastConfig()).Merge(maps, Path("joined"));
  }

  /// What Merge says when it refuses; nothing must have been written.
  static std::string RefusalOf(const std::vector<std::string>& names) {
    try {
      Merge(names);
    } catch (const InputError& error) {
      EXPECT_FALSE(fs::exists(Path("joined")));
      return error.what();
    }
    return "";
  }

  /// A copy of the second map for a test to spoil.
  static void CopySecond() {
    fs::remove_all(Path("spoiled"));
    fs::copy(Path("second"), Path("spoiled"), fs::copy_options::recursive);
  }

  static fs::path root_;
};

fs::path MapMergerTest::root_;

/// Largest distance [m] of keyframes from `first_id` on from where the walk was, in the hall.
double WorstError(const PoseGraphData& graph, std::uint32_t first_id, const Walk& walk) {
  double worst = 0.0;
  for (int i = 0; i < Walk::kKeyframes; ++i) {
    const GraphVertex& vertex = graph.vertices[first_id + static_cast<std::size_t>(i)];
    const Eigen::Vector3d truth = walk.TruthAt(i).translation();
    worst = std::max(worst, (vertex.T_map_imu.translation() - truth).norm());
  }
  return worst;
}

TEST_F(MapMergerTest, SessionsOfOnePlaceBecomeOneMap) {
  const MergedMap merged = Merge({"first", "second"});
  ASSERT_EQ(merged.sessions.size(), 1U);
  EXPECT_GE(merged.sessions[0].join.loops, 4U);
  EXPECT_EQ(merged.sessions[0].join.refused, 0U);
  EXPECT_LT(merged.sessions[0].join.residual_m, 0.05);
  EXPECT_EQ(merged.keyframes, 2U * Walk::kKeyframes);
  EXPECT_EQ(merged.unplaced, 0U);
  const MapFolder map = MapFolder::Open(Path("joined"));
  map.Verify();
  const PoseGraphData graph = map.ReadGraph();
  EXPECT_LT(WorstError(graph, 0, Walk()), 0.05);
  EXPECT_LT(WorstError(graph, Walk::kKeyframes, Elsewhere()), 0.05);
  EXPECT_EQ(map.ReadPoses().size(), 2U * Walk::kKeyframes) << "stamps are the same in both";
  EXPECT_TRUE(map.contents().occupancy);
  EXPECT_GT(map.ReadCloud().points.size(), 1000U);

  fs::rename(Path("joined"), Path("both"));
  EXPECT_NE(RefusalOf({"both", "second"}).find("the same recording cannot"), std::string::npos);
  Walk third = Elsewhere();
  third.radius_m = 4.3;
  third.noise_seed = 12;
  third.Save(Path("third"));
  Merge({"both", "third"});
  const MapFolder all = MapFolder::Open(Path("joined"));
  EXPECT_LT(WorstError(all.ReadGraph(), 2 * Walk::kKeyframes, third), 0.05);
  const StoredSubmaps submaps = ParseSubmaps(all.ReadDescriptors(), "descriptors");
  EXPECT_EQ(submaps.records.size(), submaps.descriptors.size());
  EXPECT_EQ(submaps.records.back().keyframe, submaps.descriptors.back().keyframe);
}

TEST_F(MapMergerTest, DifferentPlacesAreNotJoined) {
  const std::string refusal = RefusalOf({"first", "other_hall"});
  EXPECT_NE(refusal.find("other_hall: cannot be joined to "), std::string::npos) << refusal;
  for (const fs::directory_entry& entry : fs::directory_iterator(root_)) {
    EXPECT_NE(entry.path().filename().string().find(".joined"), 0U) << "a stage was left";
  }
}

TEST_F(MapMergerTest, TheSameMapIsNotJoinedTwice) {
  CopySecond();
  EXPECT_NE(RefusalOf({"second", "second"}).find("the same recording cannot"), std::string::npos);
  EXPECT_NE(RefusalOf({"second", "spoiled"}).find("the same recording cannot"), std::string::npos);
}

TEST_F(MapMergerTest, DamagedMapsAreRefusedByName) {
  CopySecond();
  std::fstream(Path("spoiled/keyframes/000007.pcd"), std::ios::in | std::ios::out).seekp(300)
      << "?";
  EXPECT_NE(RefusalOf({"first", "spoiled"}).find("spoiled/keyframes/000007.pcd"),
            std::string::npos);
}

TEST_F(MapMergerTest, MapsWithoutDescriptorsAreRefused) {
  const MapFolder second = MapFolder::Open(Path("second"));
  {
    MapWriter writer(Path("plain"));
    for (const std::uint32_t id : second.KeyframeIds()) {
      writer.AddKeyframe(id, second.path() + "/" + KeyframeFileName(id));
    }
    writer.AddGraph(second.ReadGraph());
    writer.Commit("");
  }
  EXPECT_NE(RefusalOf({"first", "plain"}).find("plain: cannot be joined, the map has no desc"),
            std::string::npos);
}

TEST_F(MapMergerTest, OneMapIsNotEnough) { EXPECT_THROW(Merge({"first"}), InputError); }

}  // namespace
}  // namespace hv::loop
