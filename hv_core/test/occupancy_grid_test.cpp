#include "hv_core/occupancy_grid.h"

#include <fstream>

#include "small_map.h"

namespace hv {
namespace {

const char* kYaml =
    "image: a.pgm\nresolution: 0.5\norigin: [1, 2, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
    "free_thresh: 0.196\n";

OccupancyGrid ParseCells(const std::string& yaml, const std::string& pgm) {
  return ParseGrid(yaml, "yaml", pgm, "pgm");
}

TEST(OccupancyGridFile, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const OccupancyGrid grid = SmallGrid();
  WriteGrid(folder.path(), "grid", grid);
  const OccupancyGrid back = ReadGrid(folder / "grid.yaml");
  EXPECT_EQ(back.resolution_m, grid.resolution_m);
  EXPECT_EQ(back.origin, grid.origin);
  EXPECT_EQ(back.width, grid.width);
  EXPECT_EQ(back.height, grid.height);
  EXPECT_EQ(back.cells, grid.cells);
}

TEST(OccupancyGridFile, FirstRowOfThePictureIsTheLast) {
  const OccupancyGrid grid = ParseCells(kYaml, "P2\n# comment\n2 2\n255\n0 254\n205 254\n");
  EXPECT_EQ(grid.At(0, 1), OccupancyGrid::kOccupied);
  EXPECT_EQ(grid.At(1, 1), OccupancyGrid::kFree);
  EXPECT_EQ(grid.At(0, 0), OccupancyGrid::kUnknown);
  EXPECT_EQ(grid.origin, Eigen::Vector2d(1.0, 2.0));
}

TEST(OccupancyGridFile, FaultsAreNamed) {
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string yaml = kYaml;
    yaml.replace(yaml.find(from), from.size(), to);
    return yaml;
  };
  const std::string pgm = "P2 1 1 255 0";
  const std::pair<std::string, std::string> yamls[] = {
      {"", "yaml: must be a mapping"},
      {changed("resolution: 0.5", "resolution: -1"), "yaml: resolution"},
      {changed("resolution: 0.5\n", ""), "yaml: key 'resolution'"},
      {changed("[1, 2, 0]", "[1, 2]"), "yaml: origin"},
      {changed("[1, 2, 0]", "[1, 2, 0.5]"), "yaml: an origin with a rotation"},
      {changed("negate: 0", "negate: [0"), "yaml:"}};
  for (const auto& [yaml, expected] : yamls) {
    const std::string error = ErrorOf([&yaml = yaml, &pgm] { ParseCells(yaml, pgm); });
    EXPECT_EQ(error.rfind(expected, 0), 0U) << error;
  }
  for (const char* bad : {"", "P6 1 1 255 0", "P2 0 1 255 0", "P2 1 1 65535 0", "P2 2 2 255 0 0",
                          "P5 2 2 255 abc", "P2 1 1 255 256", "P5 99999999 99999999 255 a"}) {
    const std::string error = ErrorOf([bad] { ParseCells(kYaml, bad); });
    EXPECT_EQ(error.rfind("pgm: ", 0), 0U) << bad << " gave '" << error << "'";
  }
}

}  // namespace
}  // namespace hv
