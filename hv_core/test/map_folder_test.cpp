#include "hv_core/map_folder.h"

#include <fstream>
#include <sstream>

#include "small_map.h"

namespace hv {
namespace {

namespace fs = std::filesystem;

std::string Slurp(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void Spill(const std::string& path, const std::string& text) {
  fs::remove(path);
  std::ofstream(path, std::ios::binary) << text;
}

class MapFolderTest : public testing::Test {
 protected:
  void Save(std::uint32_t variant) { SaveSmallMap(path_, folder_ / "work", variant); }
  std::string OpenError() {
    return ErrorOf([this] { MapFolder::Open(path_).Verify(); });
  }
  /// Entries beside the map, itself not counted.
  std::size_t Leftovers() {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_.path()), {})) - 1;
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "map";
};

TEST_F(MapFolderTest, EveryPartReadsBack) {
  Save(1);
  const MapFolder map = MapFolder::Open(path_ + "/");
  double done = 0.0;
  map.Verify([&done](double share) { done = share; });
  EXPECT_EQ(done, 1.0);
  const MapContents contents = map.contents();
  EXPECT_TRUE(contents.cloud && contents.keyframes && contents.graph && contents.descriptors);
  EXPECT_TRUE(contents.grid && !contents.occupancy);
  EXPECT_FALSE(map.is_plain_cloud());
  EXPECT_EQ(map.manifest().frame, "map");
  EXPECT_EQ(map.manifest().configuration, "variant: 1\n");
  EXPECT_EQ(map.manifest().keyframes, 3U);
  EXPECT_EQ(map.manifest().loops, 1U);
  EXPECT_EQ(map.manifest().cloud_points, 51U);
  EXPECT_EQ(map.KeyframeIds(), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(map.ReadCloud().points.size(), 51U);
  EXPECT_EQ(map.ReadKeyframe(2).points.size(), 21U);
  EXPECT_EQ(map.ReadKeyframe(2).sensor_origin, Eigen::Vector3f(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(map.ReadGraph().edges.size(), 4U);
  EXPECT_EQ(map.ReadPoses().size(), 3U);
  EXPECT_EQ(map.ReadDescriptors(), "descriptors 1");
  EXPECT_EQ(map.ReadGrid().cells, SmallGrid().cells);
  EXPECT_NE(ErrorOf([&map] { map.OccupancyPath(); }).find("no occupancy.bt"), std::string::npos);
  EXPECT_EQ(Leftovers(), 0U);
}

TEST_F(MapFolderTest, SavingAgainReplacesTheMap) {
  Save(1);
  Save(2);
  EXPECT_EQ(MapFolder::Open(path_).manifest().configuration, "variant: 2\n");
  SaveSmallMap(path_, folder_ / "work", 3, MapWriterOptions{false});
  EXPECT_EQ(MapFolder::Open(path_).manifest().configuration, "variant: 3\n");
  EXPECT_EQ(OpenError(), "");
  EXPECT_EQ(Leftovers(), 0U);
}

TEST_F(MapFolderTest, TheConfigurationIsKeptAsItIs) {
  for (const std::string text :
       {"", "a", "a: 1", "a: 1\n", "a: 1\n\n\n", "  indented:\n    - x\n\ttab\n",
        "\n\na: \"q\" 'r' # c\n", "files: []\nmanifest_sha256: 00\n", "unit: \xc2\xb0\n   \n"}) {
    MapWriter writer(path_);
    writer.Commit(text, "my \"frame\"");
    const MapFolder map = MapFolder::Open(path_);
    EXPECT_EQ(map.manifest().configuration, text);
    EXPECT_EQ(map.manifest().frame, "my \"frame\"");
  }
}

TEST_F(MapFolderTest, EmptyMapsAndMissingParentsAreFine) {
  const std::string deep = folder_ / "a/b/map";
  { MapWriter(deep).Commit(""); }
  EXPECT_EQ(ErrorOf([&deep] { MapFolder::Open(deep).Verify(); }), "");
}

TEST_F(MapFolderTest, WithoutCommitTheOldMapStays) {
  Save(1);
  {
    MapWriter writer(path_);
    writer.AddDescriptors("new");
  }
  EXPECT_EQ(MapFolder::Open(path_).ReadDescriptors(), "descriptors 1");
  EXPECT_EQ(Leftovers(), 0U);
}

TEST_F(MapFolderTest, FilesOfOthersInTheFolderAreKept) {
  Save(1);
  Spill(path_ + "/notes.txt", "mine");
  fs::create_directories(path_ + "/pictures/deep");
  Spill(path_ + "/pictures/deep/a.png", "picture");
  fs::create_symlink("nowhere", path_ + "/link");
  Save(2);
  EXPECT_EQ(Slurp(path_ + "/notes.txt"), "mine");
  EXPECT_EQ(Slurp(path_ + "/pictures/deep/a.png"), "picture");
  EXPECT_TRUE(fs::is_symlink(path_ + "/link"));
  EXPECT_EQ(OpenError(), "");
}

TEST_F(MapFolderTest, FoldersThatAreNoMapAreNotReplaced) {
  fs::create_directory(path_);
  Spill(path_ + "/thesis.tex", "years of work");
  EXPECT_NE(ErrorOf([this] { MapWriter writer(path_); }).find("not a map"), std::string::npos);
  EXPECT_NE(ErrorOf([this] { MapWriter writer(path_ + "/thesis.tex"); }), "");
  EXPECT_EQ(Slurp(path_ + "/thesis.tex"), "years of work");
  EXPECT_NE(OpenError().find("is not a map"), std::string::npos);
}

TEST_F(MapFolderTest, AnInterruptedReplacementIsRecovered) {
  Save(1);
  fs::rename(path_, folder_ / ".map.old");
  EXPECT_EQ(MapFolder::Open(path_).ReadDescriptors(), "descriptors 1");
  { MapWriter writer(path_); }
  EXPECT_EQ(MapFolder::Open(path_).path(), path_);
  EXPECT_EQ(Leftovers(), 0U);
}

TEST_F(MapFolderTest, StaleStagesAreRemovedLiveOnesAreNot) {
  fs::create_directories(folder_ / ".map.part-dead00/keyframes");
  MapWriter first(path_);
  MapWriter second(path_);
  EXPECT_EQ(Leftovers(), 1U);
  first.AddDescriptors("first");
  second.AddDescriptors("second");
  first.Commit("");
  second.Commit("");
  EXPECT_EQ(MapFolder::Open(path_).ReadDescriptors(), "second");
  EXPECT_EQ(Leftovers(), 0U);
}

TEST_F(MapFolderTest, KeyframesAreLinkedNotCopied) {
  KeyframeStore store(folder_ / "work", {}, Eigen::Vector3d::Zero());
  Keyframe keyframe;
  keyframe.points = RandomPoints(10, 1);
  store.Append(keyframe);
  MapWriter writer(path_);
  writer.AddKeyframe(0, store.PathOf(0));
  EXPECT_NE(ErrorOf([&] { writer.AddKeyframe(0, store.PathOf(0)); }), "");
  EXPECT_NE(ErrorOf([&] { writer.AddKeyframe(1, "/nonexistent.pcd"); }), "");
  EXPECT_EQ(fs::hard_link_count(store.PathOf(0)), 2U);
}

TEST_F(MapFolderTest, PlainCloudsAreMapsToo) {
  WritePcd(folder_ / "scans.pcd", RandomPoints(30, 5));
  const MapFolder map = MapFolder::Open(folder_ / "scans.pcd");
  EXPECT_TRUE(map.is_plain_cloud());
  EXPECT_TRUE(map.contents().cloud);
  EXPECT_FALSE(map.contents().graph || map.contents().keyframes || map.contents().grid);
  EXPECT_EQ(map.ReadCloud().points.size(), 30U);
  map.Verify();
  EXPECT_NE(ErrorOf([&map] { map.ReadGraph(); }), "");
  EXPECT_NE(ErrorOf([] { MapFolder::Open("/nonexistent"); }).find("no such map"),
            std::string::npos);
}

TEST_F(MapFolderTest, DamageIsNamed) {
  Save(1);
  const std::string manifest = path_ + "/manifest.yaml";
  const std::string graph = path_ + "/graph.g2o";
  const std::string good_graph = Slurp(graph);
  const std::string good_manifest = Slurp(manifest);

  std::string flipped = good_graph;
  flipped[flipped.size() / 2] = '7';
  Spill(graph, flipped);
  EXPECT_EQ(OpenError().rfind(graph + ": does not match its checksum", 0), 0U) << OpenError();
  Spill(graph, good_graph.substr(1));
  EXPECT_EQ(OpenError().rfind(graph + ": has ", 0), 0U) << OpenError();
  fs::remove(graph);
  EXPECT_EQ(OpenError().rfind(graph + ": is listed", 0), 0U) << OpenError();
  Spill(graph, good_graph);
  EXPECT_EQ(OpenError(), "");

  Spill(manifest, good_manifest.substr(0, good_manifest.size() / 2));
  EXPECT_EQ(OpenError().rfind(manifest + ": is cut short", 0), 0U) << OpenError();
  std::string edited = good_manifest;
  edited.replace(edited.find("loops: 1"), 8, "loops: 2");
  Spill(manifest, edited);
  EXPECT_NE(OpenError().find("damaged or edited"), std::string::npos) << OpenError();
  Spill(manifest, "format_version: 2\n" + good_manifest);
  EXPECT_NE(OpenError().find("format_version 2 is newer than 1"), std::string::npos);
  Spill(manifest, "");
  EXPECT_NE(OpenError().find("does not start with the format_version"), std::string::npos);
}

}  // namespace
}  // namespace hv
