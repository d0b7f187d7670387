#include "hv_explore_sac/exploration_map.h"

#include <unistd.h>

#include <filesystem>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "hv_core/occupancy_grid.h"
#include "random_maps.h"

namespace hv::explore {
namespace {

namespace fs = std::filesystem;

std::string MessageOf(const std::string& text) {
  try {
    ParseTiles(text, "maps.txt");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(TilesTest, ReadsBlocksCommentsAndStarts) {
  const std::string text = "# a comment\nmap one 40 8 2 0\n##S\n...\n\nmap two 3 4\r\n.#\r\n";
  const std::vector<ExplorationMap> maps = ParseTiles(text, "maps.txt");
  ASSERT_EQ(maps.size(), 2U);
  EXPECT_EQ(maps[0].name, "one");
  EXPECT_EQ(maps[0].width, 48);
  EXPECT_EQ(maps[0].height, 32);
  EXPECT_EQ(maps[0].start, Eigen::Vector2i(40, 8));
  EXPECT_EQ(maps[0].CountFree(), 4 * 256);
  EXPECT_EQ(maps[1].CountFree(), 256);
}

TEST(TilesTest, NamesWhatIsWrongAndWhere) {
  EXPECT_EQ(MessageOf(""), "maps.txt: holds no map");
  EXPECT_EQ(MessageOf("...\n"), "maps.txt, line 1: expected a line `map NAME START_X START_Y`");
  EXPECT_EQ(MessageOf("map a b c\n...\n"), "maps.txt, line 1: expected `map NAME START_X START_Y`");
  EXPECT_EQ(MessageOf("map a 1 1\n...\n..\n"),
            "maps.txt, line 3: has 2 tiles where the rows before have 3");
  EXPECT_EQ(MessageOf("map a 1 1\n..x\n"), "maps.txt, line 2: unknown tile `x`");
  EXPECT_EQ(MessageOf("map a 1 1\n..\t\n"), "maps.txt, line 2: unknown tile `?`");
  EXPECT_EQ(MessageOf("map a 1 1\n#..\n"), "maps.txt, line 3: map a starts where nothing is free");
  EXPECT_EQ(MessageOf("map a 99 1\n#..\n"), "maps.txt, line 3: map a starts where nothing is free");
  EXPECT_EQ(MessageOf("map a 1 1\n"), "maps.txt, line 2: map a has no rows");
}

TEST(TilesTest, SurvivesDamage) {
  const std::string whole = RandomTiles(1);
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = whole;
    const auto place = std::uniform_int_distribution<std::size_t>(0, whole.size() - 1)(random);
    if (i % 2 == 0) {
      damaged.resize(place);
    } else {
      damaged[place] = static_cast<char>(random() % 256);
    }
    try {
      for (const ExplorationMap& map : ParseTiles(damaged, "maps.txt")) {
        EXPECT_EQ(map.free.size(), static_cast<std::size_t>(map.width * map.height));
        EXPECT_TRUE(map.IsFree(map.IndexOf(map.start)));
      }
    } catch (const InputError&) {
    }
  }
}

class MapFiles : public testing::Test {
 protected:
  MapFiles() : folder_(fs::temp_directory_path() / ("hv_maps_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~MapFiles() override { fs::remove_all(folder_); }
  std::string Path(const std::string& name) const { return folder_ / name; }

  const fs::path folder_;
};

/// A wall of 16 cells around a room of 32 with a start square, as the benchmark draws it.
std::string BenchmarkImage() {
  std::string pixels;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const bool room = x >= 16 && x < 48 && y >= 16 && y < 48;
      const bool start = x >= 32 && x < 48 && y >= 16 && y < 32;
      pixels += static_cast<char>(start ? 208 : room ? 195 : 127);
    }
  }
  return "P5\n64 64\n255\n" + pixels;
}

TEST_F(MapFiles, ReadsFoldersOfBenchmarkImages) {
  WriteFile(Path("b.pgm"), {BenchmarkImage()});
  WriteFile(Path("a.pgm"), {BenchmarkImage()});
  WriteFile(Path("notes.txt"), {"no map"});
  const std::vector<ExplorationMap> maps = ReadExplorationMaps(folder_);
  ASSERT_EQ(maps.size(), 2U);
  EXPECT_EQ(maps[0].name, "a");
  EXPECT_EQ(maps[0].start, Eigen::Vector2i(47, 23));
  EXPECT_EQ(maps[0].CountFree(), 32 * 32);
}

TEST_F(MapFiles, RefusesWhatIsNoMap) {
  EXPECT_THROW(ReadExplorationMaps(folder_), InputError);
  EXPECT_THROW(ReadExplorationMaps(Path("absent.txt")), InputError);
  WriteFile(Path("empty.png"), {""});
  EXPECT_THROW(ReadExplorationMaps(Path("empty.png")), InputError);
  WriteFile(Path("cut.pgm"), {BenchmarkImage().substr(0, 9)});
  EXPECT_THROW(ReadExplorationMaps(Path("cut.pgm")), InputError);
  WriteFile(Path("bright.pgm"), {"P5\n2 2\n255\n\xff\xff\xff\xff"});
  EXPECT_THROW(ReadExplorationMaps(Path("bright.pgm")), InputError);
}

TEST_F(MapFiles, KeepsOfGridsWhatIsConnectedWithTheStart) {
  OccupancyGrid grid;
  grid.resolution_m = 0.5;
  grid.origin = {10.0, 20.0};
  grid.width = 12;
  grid.height = 5;
  grid.cells.assign(60, OccupancyGrid::kFree);
  for (int y = 0; y < 5; ++y) grid.At(3, y) = OccupancyGrid::kOccupied;
  grid.At(11, 4) = OccupancyGrid::kUnknown;
  WriteGrid(folder_, "grid", grid);
  const ExplorationMap map = ReadExplorationMaps(Path("grid.yaml"))[0];
  EXPECT_EQ(map.unit, "m");
  EXPECT_DOUBLE_EQ(map.cell_size, 0.5);
  EXPECT_EQ(map.origin, Eigen::Vector2d(10.25, 20.25));
  EXPECT_EQ(map.CountFree(), 8 * 5 - 1);
  EXPECT_GT(map.start.x(), 3);
}

}  // namespace
}  // namespace hv::explore
