#include "voxel_markers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hv_ros/conversions.h"

namespace hv::lio {
namespace {

using visualization_msgs::Marker;
using Triangle = std::array<Eigen::Vector3d, 3>;
using Triangles = std::vector<Triangle>;

/// A unit circle in the plane z = 0.
Triangles MakeDisc() {
  constexpr int kSides = 8;
  const auto rim = [](int i) {
    const double angle = 2.0 * M_PI * i / kSides;
    return Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
  };
  Triangles disc;
  for (int i = 0; i < kSides; ++i) disc.push_back({Eigen::Vector3d::Zero(), rim(i), rim(i + 1)});
  return disc;
}

/// The square [-1, 1]^2 in the plane z = 0.
Triangles MakeSquare() {
  const Eigen::Vector3d a(-1, -1, 0), b(1, -1, 0), c(1, 1, 0), d(-1, 1, 0);
  return {{a, b, c}, {a, c, d}};
}

/// The octahedron in the unit sphere: round enough for bodies of decimetres by the ten thousand.
Triangles MakeSphere() {
  Triangles sphere;
  for (int octant = 0; octant < 8; ++octant) {
    const double x = (octant & 1) ? -1 : 1, y = (octant & 2) ? -1 : 1, z = (octant & 4) ? -1 : 1;
    sphere.push_back(
        {Eigen::Vector3d(x, 0, 0), Eigen::Vector3d(0, y, 0), Eigen::Vector3d(0, 0, z)});
  }
  return sphere;
}

std_msgs::ColorRGBA MakeColor(const Eigen::Vector3d& rgb, double alpha) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(rgb.x());
  color.g = static_cast<float>(rgb.y());
  color.b = static_cast<float>(rgb.z());
  color.a = static_cast<float>(alpha);
  return color;
}

/// Colour of a merged plane: hues that step by the golden ratio stay apart for close ids.
std_msgs::ColorRGBA PlaneColor(std::uint32_t plane_id) {
  constexpr double kGoldenRatio = 0.618033988749895;
  const double hue = std::fmod(plane_id * kGoldenRatio, 1.0);
  const auto channel = [hue](double shift) {
    const double distance = std::abs(std::fmod(hue + shift, 1.0) * 6.0 - 3.0) - 1.0;
    return 0.25 + 0.7 * std::clamp(distance, 0.0, 1.0);
  };
  return MakeColor({channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0)}, 0.9);
}

/// How one kind of voxel is drawn: a shape scaled by the standard deviations along the axes.
struct Style {
  Triangles shape;
  double scale;  ///< half extent of the shape per standard deviation
  std_msgs::ColorRGBA color;
};

std::array<Style, 3> MakeStyles() {
  return {Style{MakeDisc(), 2.0, MakeColor({0.5, 0.6, 0.7}, 0.6)},  // uniform disc: r = 2 sigma
          Style{MakeSquare(), std::sqrt(3.0), MakeColor({1, 1, 1}, 0.9)},
          Style{MakeSphere(), 1.0, MakeColor({0.95, 0.55, 0.2}, 0.8)}};
}

Marker MakeMarker(const char* name, const std::string& frame, Time stamp) {
  Marker marker;
  marker.header.frame_id = frame;
  marker.header.stamp = ToRos(stamp);
  marker.ns = name;
  marker.type = Marker::TRIANGLE_LIST;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = MakeColor({1, 1, 1}, 1.0);
  return marker;
}

void Append(const VoxelView& voxel, const Style& style, Marker& marker) {
  const Eigen::Vector3d half = (style.scale * voxel.sigma).cwiseMin(voxel.size);
  const Eigen::Matrix3d shape_to_odom = voxel.axes * half.asDiagonal();
  const bool merged = voxel.kind == VoxelView::Kind::kMergedPlane;
  const std_msgs::ColorRGBA color = merged ? PlaneColor(voxel.plane_id) : style.color;
  for (const Triangle& triangle : style.shape) {
    for (const Eigen::Vector3d& corner : triangle) {
      const Eigen::Vector3d position = voxel.center + shape_to_odom * corner;
      geometry_msgs::Point point;
      point.x = position.x();
      point.y = position.y();
      point.z = position.z();
      marker.points.push_back(point);
      marker.colors.push_back(color);
    }
  }
}

}  // namespace

visualization_msgs::MarkerArray ToVoxelMarkers(const std::vector<VoxelView>& voxels,
                                               const std::string& frame, Time stamp) {
  const std::array<Style, 3> styles = MakeStyles();
  visualization_msgs::MarkerArray array;
  for (const char* name : {"planes", "merged_planes", "gaussians"}) {
    array.markers.push_back(MakeMarker(name, frame, stamp));
  }
  for (const VoxelView& voxel : voxels) {
    const auto kind = static_cast<std::size_t>(voxel.kind);
    Append(voxel, styles[kind], array.markers[kind]);
  }
  for (Marker& marker : array.markers) {
    if (marker.points.empty()) marker.action = Marker::DELETE;
  }
  return array;
}

}  // namespace hv::lio
