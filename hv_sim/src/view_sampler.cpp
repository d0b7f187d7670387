#include "hv_sim/view_sampler.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "hv_core/angles.h"
#include "hv_sim/random.h"
#include "hv_sim/ray_caster.h"
#include "hv_sim/route.h"

namespace hv::sim {
namespace {

constexpr int kTriesPerView = 400;
/// Height above the route from which places beside it are looked at [m].
constexpr double kEye_m = 1.0;

class Sampler {
 public:
  Sampler(const World& world, const ViewLimits& limits, const std::vector<Eigen::Vector3d>& avoid,
          std::uint32_t seed)
      : limits_(limits),
        avoid_(avoid),
        route_(SampleRoute(world.route, world.closed, 1.0, 0.1)),
        caster_(world.mesh),
        random_({seed, 0x71E35U}) {}

  std::optional<Pose> Try() {
    const auto index =
        static_cast<std::size_t>(random_.Uniform(0.0, static_cast<double>(route_.size())));
    const Eigen::Vector3d eye = route_[index] + kEye_m * Eigen::Vector3d::UnitZ();
    const double angle = random_.Uniform(-M_PI, M_PI);
    const double distance = random_.Uniform(0.0, limits_.beside_route_m);
    const Eigen::Vector3d aside(std::cos(angle), std::sin(angle), 0.0);
    if (distance > 0.0 && RangeOf(eye, aside) < distance + limits_.clearance_m) return {};
    const Eigen::Vector3d above = eye + distance * aside;
    const double floor = above.z() - RangeOf(above, -Eigen::Vector3d::UnitZ());
    const double height = random_.Uniform(limits_.least_height_m, limits_.most_height_m);
    const Eigen::Vector3d place(above.x(), above.y(), floor + height);
    const double tilt = limits_.tilt_deg * kRadiansPerDegree;
    const Eigen::Matrix3d rotation = RotationFromRpy(
        random_.Uniform(-tilt, tilt), random_.Uniform(-tilt, tilt), random_.Uniform(-M_PI, M_PI));
    if (!(std::abs(floor - route_[index].z()) < 0.5) || !IsFree(place)) return {};
    return MakePose(rotation, place);
  }

 private:
  double RangeOf(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    std::vector<Hit> hits;
    caster_.Cast({{origin.cast<float>(), direction.cast<float>()}}, 100.0F, hits);
    return static_cast<double>(hits.front().range);
  }

  bool IsFree(const Eigen::Vector3d& place) const {
    if (caster_.Distance(place, 2.0 * limits_.clearance_m) < limits_.clearance_m) return false;
    return std::none_of(avoid_.begin(), avoid_.end(), [&](const Eigen::Vector3d& other) {
      return (other - place).norm() < limits_.keep_away_m;
    });
  }

  const ViewLimits& limits_;
  const std::vector<Eigen::Vector3d>& avoid_;
  std::vector<Eigen::Vector3d> route_;
  RayCaster caster_;
  Random random_;
};

}  // namespace

std::vector<Pose> SampleViews(const World& world, int count, const ViewLimits& limits,
                              const std::vector<Eigen::Vector3d>& avoid, std::uint32_t seed) {
  Sampler sampler(world, limits, avoid, seed);
  std::vector<Pose> views;
  for (int i = 0; i < count * kTriesPerView && static_cast<int>(views.size()) < count; ++i) {
    if (const std::optional<Pose> view = sampler.Try()) views.push_back(*view);
  }
  return views;
}

}  // namespace hv::sim
