#include "hv_core/point_cloud_file.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <unordered_map>

#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "point_fields.h"

namespace hv {
namespace {

bool IsPly(std::string_view bytes) {
  return bytes.substr(0, 4) == "ply\n" || bytes.substr(0, 5) == "ply\r\n";
}

/// Number of the cube around a point, 21 bits an axis; false when it is too far away.
bool CubeOf(const Point& point, double leaf_m, std::uint64_t& cube) {
  constexpr double kHalf = 1U << 20U;
  cube = 0;
  for (const float coordinate : {point.x, point.y, point.z}) {
    const double index = std::floor(static_cast<double>(coordinate) / leaf_m) + kHalf;
    if (!(index >= 0.0 && index < 2.0 * kHalf)) return false;
    cube = (cube << 21U) | static_cast<std::uint64_t>(index);
  }
  return true;
}

struct CubeSum {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  double count = 0.0;
  Point first;
};

Point MeanOf(const CubeSum& cube) {
  const Eigen::Vector4f mean = (cube.sum / cube.count).cast<float>();
  Point point = cube.first;
  point.x = mean[0];
  point.y = mean[1];
  point.z = mean[2];
  point.intensity = mean[3];
  return point;
}

}  // namespace

PointCloud ParsePointCloud(std::string_view bytes, const std::string& source) {
  return IsPly(bytes) ? ParsePly(bytes, source) : ParsePcd(bytes, source);
}

PointCloud ReadPointCloud(const std::string& path) { return ParsePointCloud(ReadFile(path), path); }

void WritePointCloud(const std::string& path, const std::vector<Point>& points) {
  const std::string extension = std::filesystem::path(path).extension();
  if (extension == ".ply") {
    WritePly(path, points);
  } else if (extension == ".pcd") {
    WritePcd(path, points);
  } else {
    throw InputError(path + ": the name must end in .pcd or .ply");
  }
}

std::vector<Point> ThinPoints(const std::vector<Point>& points, double leaf_m) {
  std::unordered_map<std::uint64_t, std::size_t> index_of_cube;
  std::vector<CubeSum> cubes;
  for (const Point& point : points) {
    std::uint64_t cube = 0;
    if (!CubeOf(point, leaf_m, cube)) continue;
    const auto [entry, is_new] = index_of_cube.emplace(cube, cubes.size());
    if (is_new) cubes.emplace_back().first = point;
    cubes[entry->second].sum +=
        Eigen::Vector4f(point.x, point.y, point.z, point.intensity).cast<double>();
    cubes[entry->second].count += 1.0;
  }
  std::vector<Point> thinned;
  thinned.reserve(cubes.size());
  for (const CubeSum& cube : cubes) thinned.push_back(MeanOf(cube));
  return thinned;
}

}  // namespace hv
