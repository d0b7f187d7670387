#include "hv_sim/start_pose.h"

#include <cmath>
#include <optional>

#include "hv_core/error.h"
#include "hv_sim/ground.h"
#include "hv_sim/mesh_builder.h"
#include "hv_sim/random.h"
#include "hv_sim/route.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

constexpr int kTries = 5000;
constexpr double kBeside_m = 4.0;
constexpr double kGlance_m = 0.5;  ///< height from which places beside the route are looked at
constexpr double kFree_m = 0.15;
constexpr double kFreeOfPeople_m = 1.0;

bool Sees(const RayCaster& scene, const Vector3d& from, const Vector3d& to) {
  const Vector3d way = to - from;
  const double distance = way.norm();
  if (distance == 0.0) return true;
  std::vector<Hit> hits;
  scene.Cast({{from.cast<float>(), (way / distance).cast<float>()}}, static_cast<float>(distance),
             hits);
  return !std::isfinite(hits.front().range);
}

/// A place beside the route with the floor under it, looking anywhere.
std::optional<Pose> PlaceBeside(const std::vector<Vector3d>& route, const RayCaster& scene,
                                Random& random) {
  const auto index =
      static_cast<std::size_t>(random.Uniform(0.0, static_cast<double>(route.size())));
  const double angle = random.Uniform(-M_PI, M_PI);
  const double beside = random.Uniform(0.0, kBeside_m);
  const double yaw = random.Uniform(-M_PI, M_PI);
  const Vector3d eye = route[index] + kGlance_m * Vector3d::UnitZ();
  const Vector3d above = eye + beside * Vector3d(std::cos(angle), std::sin(angle), 0.0);
  if (!Sees(scene, eye, above)) return std::nullopt;
  const auto floor = FloorBelow(scene, above, 2.0 * kGlance_m);
  if (!floor) return std::nullopt;
  return Upright({above.x(), above.y(), *floor}, yaw);
}

}  // namespace

Pose RandomStart(const World& world, const std::shared_ptr<const RayCaster>& scene,
                 const RobotBodyConfig& robot, std::uint32_t seed) {
  const CollisionChecker checker(robot.shape, scene, world.people);
  const WheelLayout wheels{robot.wheel_base_m, robot.drive.track_m};
  const std::vector<Vector3d> route = SampleRoute(world.route, world.closed, 1.0, 0.1);
  Random random({seed, 0x57A27U});
  for (int i = 0; i < kTries; ++i) {
    const auto place = PlaceBeside(route, *scene, random);
    if (!place) continue;
    const auto ground = OnGround(*scene, wheels, *place);
    if (!ground) continue;
    const Clearance clearance = checker.At(*ground, 0.0, kFreeOfPeople_m);
    if (clearance.static_m >= kFree_m && clearance.person_m >= kFreeOfPeople_m) return *ground;
  }
  throw InputError("world '" + world.name + "': found no room for the robot");
}

}  // namespace hv::sim
