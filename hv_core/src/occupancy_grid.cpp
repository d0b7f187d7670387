#include "hv_core/occupancy_grid.h"

#include <cmath>
#include <cstdio>
#include <filesystem>

#include <yaml-cpp/yaml.h>

#include "fail.h"
#include "hv_core/config.h"
#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "point_fields.h"
#include "yaml_value.h"

namespace hv {
namespace {

constexpr unsigned char kFreePixel = 254;
constexpr unsigned char kUnknownPixel = 205;
constexpr unsigned char kOccupiedPixel = 0;

unsigned char PixelOf(std::int8_t cell) {
  if (cell == OccupancyGrid::kUnknown) return kUnknownPixel;
  return cell == OccupancyGrid::kOccupied ? kOccupiedPixel : kFreePixel;
}

std::string ToPgm(const OccupancyGrid& grid) {
  std::string text =
      "P5\n" + std::to_string(grid.width) + " " + std::to_string(grid.height) + "\n255\n";
  for (int row = grid.height - 1; row >= 0; --row) {
    for (int column = 0; column < grid.width; ++column) {
      text += static_cast<char>(PixelOf(grid.At(column, row)));
    }
  }
  return text;
}

std::string ToYaml(const OccupancyGrid& grid, const std::string& image) {
  char text[400];
  std::snprintf(text, sizeof(text),
                "resolution: %.17g\norigin: [%.17g, %.17g, 0.0]\nnegate: 0\n"
                "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
                grid.resolution_m, grid.origin.x(), grid.origin.y());
  return "image: " + image + "\n" + text;
}

struct Image {
  int width = 0;
  int height = 0;
  int white = 255;
  std::vector<int> pixels;  ///< top row first
};

/// Walks over the numbers of a PGM, skipping blanks and comments.
class PgmReader {
 public:
  PgmReader(std::string_view bytes, const std::string& source) : rest_(bytes), source_(source) {}

  Image Read() {
    const std::string_view magic = rest_.substr(0, 2);
    if (magic != "P2" && magic != "P5") Fail(source_, "not a PGM image (P2 or P5)");
    rest_.remove_prefix(2);
    Image image;
    image.width = Number();
    image.height = Number();
    image.white = Number();
    if (image.width <= 0 || image.height <= 0) Fail(source_, "PGM has no width or height");
    if (image.white <= 0 || image.white > 255) Fail(source_, "only 8-bit PGM images can be read");
    ReadPixels(magic == "P5", image);
    return image;
  }

 private:
  void ReadPixels(bool binary, Image& image) {
    if (binary && !rest_.empty()) rest_.remove_prefix(1);
    const std::size_t count =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    if (count > rest_.size()) Fail(source_, "PGM is cut short");
    image.pixels.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const int value = binary ? static_cast<unsigned char>(rest_[i]) : Number();
      if (value < 0 || value > image.white) Fail(source_, "PGM has a bad or missing pixel");
      image.pixels.push_back(value);
    }
  }

  /// -1 when the next word is no whole number below 1e9.
  int Number() {
    SkipBlanks();
    const std::size_t end = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
    std::size_t value = 0;
    if (end > 9 || !ParseCount(rest_.substr(0, end), value)) return -1;
    rest_.remove_prefix(end);
    return static_cast<int>(value);
  }

  void SkipBlanks() {
    for (;;) {
      const std::size_t first = rest_.find_first_not_of(" \t\r\n\v\f");
      rest_.remove_prefix(std::min(first, rest_.size()));
      if (rest_.empty() || rest_.front() != '#') return;
      rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
    }
  }

  std::string_view rest_;
  const std::string source_;
};

YAML::Node ParseMap(const std::string& yaml, const std::string& source) {
  const YAML::Node node = ParseYaml(yaml, source);
  if (!node.IsMap()) Fail(source, "must be a mapping, as map_server reads it");
  return node;
}

struct Thresholds {
  bool negate = false;
  double occupied = 0.65;
  double free = 0.196;
};

Thresholds ReadThresholds(const YAML::Node& node, const std::string& source) {
  Thresholds thresholds;
  thresholds.negate = YamlValue<int>(node, "negate", source) != 0;
  thresholds.occupied = YamlValue<double>(node, "occupied_thresh", source);
  thresholds.free = YamlValue<double>(node, "free_thresh", source);
  return thresholds;
}

/// Resolution and origin; no cells yet.
OccupancyGrid ReadFrame(const YAML::Node& node, const std::string& source) {
  OccupancyGrid grid;
  grid.resolution_m = YamlValue<double>(node, "resolution", source);
  if (!(grid.resolution_m > 0.0 && grid.resolution_m < 1e6)) {
    Fail(source, "resolution must be above 0");
  }
  const auto origin = YamlValue<std::vector<double>>(node, "origin", source);
  if (origin.size() != 3 || !std::isfinite(origin[0]) || !std::isfinite(origin[1])) {
    Fail(source, "origin must be three numbers x, y, yaw");
  }
  if (origin[2] != 0.0) Fail(source, "an origin with a rotation is not supported");
  grid.origin = {origin[0], origin[1]};
  return grid;
}

std::int8_t CellOf(int pixel, int white, const Thresholds& thresholds) {
  const double bright = static_cast<double>(pixel) / white;
  const double occupancy = thresholds.negate ? bright : 1.0 - bright;
  if (occupancy > thresholds.occupied) return OccupancyGrid::kOccupied;
  return occupancy < thresholds.free ? OccupancyGrid::kFree : OccupancyGrid::kUnknown;
}

}  // namespace

void WriteGrid(const std::string& folder, const std::string& name, const OccupancyGrid& grid) {
  WriteFile(folder + "/" + name + ".pgm", {ToPgm(grid)});
  WriteFile(folder + "/" + name + ".yaml", {ToYaml(grid, name + ".pgm")});
}

OccupancyGrid ReadGrid(const std::string& yaml_path) {
  const std::string yaml = ReadFile(yaml_path);
  const auto image = YamlValue<std::string>(ParseMap(yaml, yaml_path), "image", yaml_path);
  const std::string pgm_path = std::filesystem::path(yaml_path).parent_path() / image;
  return ParseGrid(yaml, yaml_path, ReadFile(pgm_path), pgm_path);
}

OccupancyGrid ParseGrid(const std::string& yaml, const std::string& yaml_source,
                        std::string_view pgm, const std::string& pgm_source) {
  const YAML::Node node = ParseMap(yaml, yaml_source);
  const Thresholds thresholds = ReadThresholds(node, yaml_source);
  OccupancyGrid grid = ReadFrame(node, yaml_source);
  const Image image = PgmReader(pgm, pgm_source).Read();
  grid.width = image.width;
  grid.height = image.height;
  grid.cells.resize(image.pixels.size());
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const std::size_t pixel =
          static_cast<std::size_t>(grid.height - 1 - row) * static_cast<std::size_t>(grid.width) +
          static_cast<std::size_t>(column);
      grid.At(column, row) = CellOf(image.pixels[pixel], image.white, thresholds);
    }
  }
  return grid;
}

}  // namespace hv
