#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "hv_core/scan.h"

namespace hv {

/// What a point cloud file holds. Point::time and Point::ring are not stored and stay 0.
struct PointCloud {
  std::vector<Point> points;
  bool has_intensity = false;
  std::size_t dropped = 0;  ///< points left out because a coordinate is not finite
  /// Where the sensor was, in the frame of the points [m]: the VIEWPOINT of a PCD.
  Eigen::Vector3f sensor_origin = Eigen::Vector3f::Zero();
};

/// Reads a PCD (ascii, binary, binary_compressed) or PLY (ascii, binary); the content decides
/// which. Needs numeric fields x, y and z; `intensity` (also `i`, `scalar_Intensity`) is optional,
/// all else is skipped. Throws InputError naming the file and what is wrong with it: sizes in the
/// header are compared with those of the file before anything is allocated or decoded.
PointCloud ReadPointCloud(const std::string& path);

/// The same from bytes in memory; `source` names them in messages.
PointCloud ParsePointCloud(std::string_view bytes, const std::string& source);

enum class PcdEncoding { kBinary, kCompressed };

/// Writes x, y, z and intensity as a PCD 0.7. Throws InputError when the file cannot be written;
/// `path` is then as it was before.
void WritePcd(const std::string& path, const std::vector<Point>& points,
              PcdEncoding encoding = PcdEncoding::kBinary,
              const Eigen::Vector3f& sensor_origin = Eigen::Vector3f::Zero());

/// Writes x, y, z and intensity as a binary little-endian PLY. Throws InputError as WritePcd does.
void WritePly(const std::string& path, const std::vector<Point>& points);

/// Writes a PLY when `path` ends in .ply, a PCD when it ends in .pcd; InputError otherwise.
void WritePointCloud(const std::string& path, const std::vector<Point>& points);

/// One point for each occupied cube of edge `leaf_m` [m]: mean position and intensity; cubes in
/// order of first appearance, aligned to the origin. Points that are not finite or further away
/// than 2^20 cubes are left out. Time and ring of the first point stay.
std::vector<Point> ThinPoints(const std::vector<Point>& points, double leaf_m);

}  // namespace hv
