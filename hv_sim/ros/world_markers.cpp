#include "world_markers.h"

#include <cmath>

#include "hv_ros/conversions.h"
#include "hv_sim/pedestrian.h"
#include "hv_sim/ray_caster.h"

namespace hv::sim {
namespace {

using Eigen::Vector3f;

std_msgs::ColorRGBA Grey(float brightness) {
  std_msgs::ColorRGBA color;
  color.r = color.g = color.b = brightness;
  color.a = 1.0F;
  return color;
}

float RangeTo(const RayCaster& caster, const Vector3f& from, const Vector3f& direction) {
  constexpr float kReach = 50.0F;
  constexpr float kOff = 0.02F;  // the triangle itself
  std::vector<Hit> hits;
  caster.Cast({{from + kOff * direction, direction}}, kReach, hits);
  return hits.front().range;
}

/// Level, nothing above, and room to walk below.
bool IsRoof(const RayCaster& caster, const Vector3f& center, const Vector3f& normal) {
  constexpr float kLevel = 0.7F;
  constexpr float kRoom = 1.8F;
  if (std::abs(normal.z()) < kLevel) return false;
  if (std::isfinite(RangeTo(caster, center, Vector3f::UnitZ()))) return false;
  const float below = RangeTo(caster, center, -Vector3f::UnitZ());
  return std::isfinite(below) && below > kRoom;
}

geometry_msgs::Pose Still() { return ToPoseMessage(Pose::Identity()); }

}  // namespace

visualization_msgs::Marker WorldMarker(const Mesh& mesh, const std::string& frame) {
  const RayCaster caster(mesh);
  visualization_msgs::Marker marker;
  marker.header.frame_id = frame;
  marker.ns = "world";
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.pose = Still();
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = Grey(1.0F);
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3f& from = mesh.vertices[a];
    const Vector3f normal = (mesh.vertices[b] - from).cross(mesh.vertices[c] - from).normalized();
    const Vector3f center = (from + mesh.vertices[b] + mesh.vertices[c]) / 3.0F;
    if (IsRoof(caster, center, normal)) continue;
    const std_msgs::ColorRGBA color =
        Grey(0.45F + 0.25F * std::abs(normal.z()) + 0.15F * std::abs(normal.x()));
    for (const std::uint32_t corner : {a, b, c}) {
      marker.points.push_back(ToPointMessage(mesh.vertices[corner].cast<double>()));
      marker.colors.push_back(color);
    }
  }
  return marker;
}

visualization_msgs::MarkerArray PeopleMarkers(const std::vector<PersonPath>& people, double time_s,
                                              const std::string& frame) {
  constexpr double kHeight = 1.75;
  visualization_msgs::MarkerArray array;
  for (const PersonPath& path : people) {
    visualization_msgs::Marker marker;
    marker.header.frame_id = frame;
    marker.ns = "people";
    marker.id = static_cast<int>(array.markers.size());
    marker.type = visualization_msgs::Marker::CYLINDER;
    marker.pose = Still();
    marker.pose.position =
        ToPointMessage(FeetAt(path, time_s) + 0.5 * kHeight * Eigen::Vector3d::UnitZ());
    marker.scale.x = marker.scale.y = 0.45;
    marker.scale.z = kHeight;
    marker.color = Grey(0.2F);
    marker.color.b = 0.9F;
    array.markers.push_back(marker);
  }
  return array;
}

}  // namespace hv::sim
