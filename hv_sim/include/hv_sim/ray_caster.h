#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "hv_sim/world.h"

namespace hv::sim {

struct Ray {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();      ///< world frame [m]
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();  ///< unit length
};

/// Where a ray meets a surface.
struct Hit {
  float range = std::numeric_limits<float>::infinity();  ///< [m]; infinite when nothing is met
  float cosine = 0.0F;        ///< of the angle between ray and surface normal, in [0, 1]
  float reflectivity = 0.0F;  ///< in [0, 1]
};

/// Exact queries against the static triangles of a world. Const methods are thread-safe.
class RayCaster {
 public:
  explicit RayCaster(const Mesh& mesh);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// First surface along each ray up to `max_range` [m]; `hits` gets one entry a ray. Fastest when
  /// neighbouring rays are alike.
  void Cast(const std::vector<Ray>& rays, float max_range, std::vector<Hit>& hits) const;

  /// Distance from `point` to the nearest triangle, at most `limit` [m].
  double Distance(const Eigen::Vector3d& point, double limit) const;

  using Triangle = std::array<Eigen::Vector3f, 3>;
  /// Shows `visit` every triangle within `radius` [m] of `point`, and perhaps some a little further
  /// away, in no particular order.
  void VisitNear(const Eigen::Vector3d& point, double radius,
                 const std::function<void(const Triangle&)>& visit) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace hv::sim
