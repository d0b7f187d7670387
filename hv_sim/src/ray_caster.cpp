#include "hv_sim/ray_caster.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace hv::sim {
namespace {

using Eigen::Vector3f;

constexpr std::size_t kPacket = 8;

struct alignas(32) Packet {
  RTCRayHit8 rays{};
  std::array<int, kPacket> valid{};
};

void Fill(const std::vector<Ray>& rays, std::size_t first, float max_range, Packet& packet) {
  RTCRay8& lanes = packet.rays.ray;
  for (std::size_t lane = 0; lane < kPacket; ++lane) {
    const bool used = first + lane < rays.size();
    const Ray& ray = rays[used ? first + lane : first];
    packet.valid[lane] = used ? -1 : 0;
    lanes.org_x[lane] = ray.origin.x();
    lanes.org_y[lane] = ray.origin.y();
    lanes.org_z[lane] = ray.origin.z();
    lanes.dir_x[lane] = ray.direction.x();
    lanes.dir_y[lane] = ray.direction.y();
    lanes.dir_z[lane] = ray.direction.z();
    lanes.tnear[lane] = 0.0F;
    lanes.tfar[lane] = max_range;
    lanes.time[lane] = 0.0F;
    lanes.mask[lane] = ~0U;
    lanes.flags[lane] = 0;
    packet.rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
  }
}

/// Nearest point of triangle abc to p (Ericson, Real-Time Collision Detection, 5.1.5).
Vector3f NearestInTriangle(const Vector3f& p, const Vector3f& a, const Vector3f& b,
                           const Vector3f& c) {
  const Vector3f ab = b - a;
  const Vector3f ac = c - a;
  const float d1 = ab.dot(p - a);
  const float d2 = ac.dot(p - a);
  if (d1 <= 0.0F && d2 <= 0.0F) return a;
  const float d3 = ab.dot(p - b);
  const float d4 = ac.dot(p - b);
  if (d3 >= 0.0F && d4 <= d3) return b;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0F && d1 >= 0.0F && d3 <= 0.0F) return a + d1 / (d1 - d3) * ab;
  const float d5 = ab.dot(p - c);
  const float d6 = ac.dot(p - c);
  if (d6 >= 0.0F && d5 <= d6) return c;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0F && d2 >= 0.0F && d6 <= 0.0F) return a + d2 / (d2 - d6) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0.0F && d4 >= d3 && d5 >= d6) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const float scale = 1.0F / (va + vb + vc);
  return a + vb * scale * ab + vc * scale * ac;
}

struct NearestQuery {
  const Mesh* mesh;
  Vector3f point;
};

bool VisitTriangle(RTCPointQueryFunctionArguments* arguments) {
  const auto* query = static_cast<const NearestQuery*>(arguments->userPtr);
  const auto& corners = query->mesh->triangles[arguments->primID];
  const auto corner = [&](std::size_t i) { return query->mesh->vertices[corners[i]]; };
  const Vector3f nearest = NearestInTriangle(query->point, corner(0), corner(1), corner(2));
  const float distance = (nearest - query->point).norm();
  if (!(distance < arguments->query->radius)) return false;
  arguments->query->radius = distance;
  return true;
}

struct VisitQuery {
  const Mesh* mesh;
  const std::function<void(const RayCaster::Triangle&)>* visit;
};

bool PassTriangle(RTCPointQueryFunctionArguments* arguments) {
  const auto* query = static_cast<const VisitQuery*>(arguments->userPtr);
  const auto& corners = query->mesh->triangles[arguments->primID];
  const auto corner = [&](std::size_t i) { return query->mesh->vertices[corners[i]]; };
  (*query->visit)({corner(0), corner(1), corner(2)});
  return false;
}

/// Calls `function` for the triangles whose bounds are within `radius` of `point`; it may shrink
/// the radius, which is returned.
double RunPointQuery(RTCScene scene, const Eigen::Vector3f& point, double radius,
                     RTCPointQueryFunction function, void* user) {
  RTCPointQuery query{};
  query.x = point.x();
  query.y = point.y();
  query.z = point.z();
  query.radius = static_cast<float>(radius);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene, &query, &context, function, user);
  return static_cast<double>(query.radius);
}

}  // namespace

struct RayCaster::Scene {
  explicit Scene(const Mesh& source) : mesh(source), device(rtcNewDevice(nullptr)) {
    if (device == nullptr) throw std::runtime_error("Embree: cannot create a device");
    scene = rtcNewScene(device);
    // Robust: a ray must not slip between two triangles that share an edge.
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    AttachMesh();
    rtcCommitScene(scene);
  }
  ~Scene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void AttachMesh() {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.vertices.size()));
    for (const Vector3f& vertex : mesh.vertices) {
      vertices = std::copy(vertex.data(), vertex.data() + 3, vertices);
    }
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) {
      indices = std::copy(triangle.begin(), triangle.end(), indices);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }

  Hit Read(const Packet& packet, std::size_t lane) const {
    const RTCHit8& hit = packet.rays.hit;
    if (hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) return {};
    const RTCRay8& ray = packet.rays.ray;
    const Vector3f normal(hit.Ng_x[lane], hit.Ng_y[lane], hit.Ng_z[lane]);
    const Vector3f direction(ray.dir_x[lane], ray.dir_y[lane], ray.dir_z[lane]);
    return {ray.tfar[lane], std::abs(normal.normalized().dot(direction)),
            mesh.reflectivity[hit.primID[lane]]};
  }

  Mesh mesh;
  RTCDevice device;
  RTCScene scene = nullptr;
};

RayCaster::RayCaster(const Mesh& mesh) : scene_(std::make_unique<Scene>(mesh)) {}
RayCaster::~RayCaster() = default;

void RayCaster::Cast(const std::vector<Ray>& rays, float max_range, std::vector<Hit>& hits) const {
  hits.resize(rays.size());
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  Packet packet;
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    Fill(rays, first, max_range, packet);
    rtcIntersect8(packet.valid.data(), scene_->scene, &context, &packet.rays);
    const std::size_t count = std::min(kPacket, rays.size() - first);
    for (std::size_t lane = 0; lane < count; ++lane) {
      hits[first + lane] = scene_->Read(packet, lane);
    }
  }
}

double RayCaster::Distance(const Eigen::Vector3d& point, double limit) const {
  NearestQuery nearest{&scene_->mesh, point.cast<float>()};
  return RunPointQuery(scene_->scene, nearest.point, limit, VisitTriangle, &nearest);
}

void RayCaster::VisitNear(const Eigen::Vector3d& point, double radius,
                          const std::function<void(const Triangle&)>& visit) const {
  VisitQuery query{&scene_->mesh, &visit};
  RunPointQuery(scene_->scene, point.cast<float>(), radius, PassTriangle, &query);
}

}  // namespace hv::sim
