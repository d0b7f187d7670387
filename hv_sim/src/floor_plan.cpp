#include "hv_sim/floor_plan.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "hv_core/config.h"
#include "hv_core/error.h"
#include "hv_core/one_line.h"
#include "hv_sim/mesh_builder.h"

namespace hv::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Image {
  int width = 0;
  int height = 0;
  int white = 255;
  std::vector<int> pixels;  ///< top row first
};

[[noreturn]] void Fail(const std::string& path, const std::string& fault) {
  throw InputError(OneLine(path + ": " + fault));
}

/// Next number of a PGM header or P2 body, skipping comments; -1 when there is none.
int NextNumber(std::istream& in) {
  while (in >> std::ws && in.peek() == '#') {
    std::string comment;
    std::getline(in, comment);
  }
  int value = -1;
  return in >> value && value >= 0 ? value : -1;
}

void ReadPixels(std::istream& in, bool binary, const std::string& path, Image& image) {
  const std::size_t count =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (binary) {
    in.get();  // the single white space after the header
    std::string bytes(count, '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(count));
    if (in.gcount() != static_cast<std::streamsize>(count)) Fail(path, "image is cut short");
    for (const char byte : bytes) image.pixels.push_back(static_cast<unsigned char>(byte));
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const int value = NextNumber(in);
    if (value < 0 || value > image.white) Fail(path, "bad or missing pixel " + std::to_string(i));
    image.pixels.push_back(value);
  }
}

Image ReadPgm(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) Fail(path, "cannot be opened");
  std::string magic;
  in >> magic;
  if (magic != "P2" && magic != "P5") Fail(path, "not a PGM image (P2 or P5)");
  Image image;
  image.width = NextNumber(in);
  image.height = NextNumber(in);
  image.white = NextNumber(in);
  constexpr int kLongest = 20000;
  if (image.width <= 0 || image.height <= 0 || image.width > kLongest || image.height > kLongest) {
    Fail(path, "width and height must be between 1 and 20000");
  }
  if (image.white <= 0 || image.white > 255) Fail(path, "only 8-bit images are supported");
  ReadPixels(in, magic == "P5", path, image);
  return image;
}

template <typename T>
T Value(const YAML::Node& node, const std::string& path, const char* key) {
  if (!node[key]) Fail(path, std::string("key '") + key + "' is missing");
  try {
    return node[key].as<T>();
  } catch (const YAML::Exception&) {
    Fail(path, std::string("key '") + key + "' has the wrong type");
  }
}

Cell Classify(double occupancy, double occupied, double free) {
  if (occupancy > occupied) return Cell::kOccupied;
  return occupancy < free ? Cell::kFree : Cell::kUnknown;
}

void FillCells(const Image& image, const YAML::Node& node, FloorPlan& plan) {
  const bool negate = node["negate"] && Value<int>(node, plan.path, "negate") != 0;
  const auto occupied = Value<double>(node, plan.path, "occupied_thresh");
  const auto free = Value<double>(node, plan.path, "free_thresh");
  plan.width = image.width;
  plan.height = image.height;
  for (int row = image.height - 1; row >= 0; --row) {
    for (int column = 0; column < image.width; ++column) {
      const auto index = static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(column);
      const double bright = static_cast<double>(image.pixels[index]) / image.white;
      plan.cells.push_back(Classify(negate ? bright : 1.0 - bright, occupied, free));
    }
  }
}

/// Floor and ceiling, as one quad for each stretch of a few metres of known cells.
void AddFloorAndCeiling(const FloorPlan& plan, double ceiling, MeshBuilder& mesh) {
  const int tile = std::max(1, static_cast<int>(std::lround(2.0 / plan.resolution)));
  const auto known = [&plan](int column, int row) {
    return plan.At(column, row) != Cell::kUnknown;
  };
  for (int row = 0; row < plan.height; row += tile) {
    for (int column = 0; column < plan.width; column += tile) {
      const int top = std::min(plan.height, row + tile);
      const int right = std::min(plan.width, column + tile);
      bool any = false;
      for (int r = row; r < top && !any; ++r) {
        for (int c = column; c < right && !any; ++c) any = known(c, r);
      }
      if (!any) continue;
      const Vector2d corner = plan.origin + plan.resolution * Vector2d(column, row);
      const Vector3d u(plan.resolution * (right - column), 0.0, 0.0);
      const Vector3d v(0.0, plan.resolution * (top - row), 0.0);
      mesh.SetReflectivity(0.3);
      mesh.AddQuad({corner.x(), corner.y(), 0.0}, u, v, 1.0);
      mesh.SetReflectivity(0.8);
      mesh.AddQuad({corner.x(), corner.y(), ceiling}, u, v, 1.0);
    }
  }
}

}  // namespace

Cell FloorPlan::At(int column, int row) const {
  return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(column)];
}

Vector2d FloorPlan::Center(int column, int row) const {
  return origin + resolution * Vector2d(column + 0.5, row + 0.5);
}

FloorPlan ReadFloorPlan(const std::string& yaml_path) {
  const YAML::Node node = LoadYamlFile(yaml_path);
  if (!node.IsMap()) Fail(yaml_path, "not a map_server file");
  FloorPlan plan;
  plan.path = yaml_path;
  plan.resolution = Value<double>(node, yaml_path, "resolution");
  if (!(plan.resolution > 0.0 && plan.resolution < 10.0)) {
    Fail(yaml_path, "resolution must be in (0, 10) m");
  }
  const auto origin = Value<std::vector<double>>(node, yaml_path, "origin");
  if (origin.size() != 3 || origin[2] != 0.0) {
    Fail(yaml_path, "origin must be [x, y, 0]; turned maps are not supported");
  }
  plan.origin = Vector2d(origin[0], origin[1]);
  const std::filesystem::path image = Value<std::string>(node, yaml_path, "image");
  const std::filesystem::path folder = std::filesystem::path(yaml_path).parent_path();
  FillCells(ReadPgm((folder / image).string()), node, plan);
  return plan;
}

std::vector<CellBlock> MergeOccupied(const FloorPlan& plan) {
  std::vector<bool> done(plan.cells.size(), false);
  const auto open = [&](int column, int row) {
    const auto index = static_cast<std::size_t>(row) * static_cast<std::size_t>(plan.width) +
                       static_cast<std::size_t>(column);
    return !done[index] && plan.cells[index] == Cell::kOccupied;
  };
  const auto row_open = [&](const CellBlock& block, int row) {
    for (int c = block.column; c < block.column + block.width; ++c) {
      if (!open(c, row)) return false;
    }
    return true;
  };
  std::vector<CellBlock> blocks;
  for (int row = 0; row < plan.height; ++row) {
    for (int column = 0; column < plan.width; ++column) {
      if (!open(column, row)) continue;
      CellBlock block{column, row, 1, 1};
      while (column + block.width < plan.width && open(column + block.width, row)) ++block.width;
      while (row + block.height < plan.height && row_open(block, row + block.height)) {
        ++block.height;
      }
      for (int r = row; r < row + block.height; ++r) {
        const auto first = done.begin() + static_cast<std::ptrdiff_t>(r) * plan.width + column;
        std::fill(first, first + block.width, true);
      }
      blocks.push_back(block);
    }
  }
  return blocks;
}

FloorPlan CloseBorders(FloorPlan plan) {
  std::vector<Cell> closed = plan.cells;
  const auto touches_free = [&plan](int column, int row) {
    for (int r = std::max(0, row - 1); r <= std::min(plan.height - 1, row + 1); ++r) {
      for (int c = std::max(0, column - 1); c <= std::min(plan.width - 1, column + 1); ++c) {
        if (plan.At(c, r) == Cell::kFree) return true;
      }
    }
    return false;
  };
  for (std::size_t i = 0; i < closed.size(); ++i) {
    const int column = static_cast<int>(i) % plan.width;
    const int row = static_cast<int>(i) / plan.width;
    if (closed[i] == Cell::kUnknown && touches_free(column, row)) closed[i] = Cell::kOccupied;
  }
  plan.cells = std::move(closed);
  return plan;
}

World ExtrudeFloorPlan(const FloorPlan& plan, std::uint32_t seed) {
  constexpr double kCeiling = 2.7;
  World world;
  world.name = std::filesystem::path(plan.path).stem().string();
  world.closed = false;
  world.route = PlanRoute(plan, seed);
  MeshBuilder mesh;
  AddFloorAndCeiling(plan, kCeiling, mesh);
  mesh.SetReflectivity(0.6);
  for (const CellBlock& block : MergeOccupied(CloseBorders(plan))) {
    const Vector2d low = plan.origin + plan.resolution * Vector2d(block.column, block.row);
    const Vector2d size = plan.resolution * Vector2d(block.width, block.height);
    mesh.AddBox(Pose::Identity(), Vector3d(low.x(), low.y(), 0.0),
                Vector3d(low.x() + size.x(), low.y() + size.y(), kCeiling));
  }
  mesh.Undulate(0.004, 1.3, seed);
  world.mesh = mesh.mesh();
  return world;
}

}  // namespace hv::sim
