#include "hv_replay/reachable_ground.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "hv_sim/ground.h"
#include "hv_sim/mesh_builder.h"
#include "hv_sim/ray_caster.h"

namespace hv::replay {
namespace {

constexpr double kCell_m = 0.2;
constexpr double kStep_m = 0.12;  ///< that a robot climbs from one place to the next, on ramps

/// Spreads over the floor from where a robot stands.
class Flood {
 public:
  Flood(const sim::World& world, const sim::RobotShape& shape)
      : scene_(std::make_shared<sim::RayCaster>(world.mesh)),
        radius_m_(std::min({shape.front_m, shape.back_m, shape.half_width_m})),
        checker_(Slim(shape), scene_, {}) {}

  std::vector<Eigen::Vector3d> From(const Eigen::Vector3d& start) {
    std::vector<Eigen::Vector3d> places = {start};
    std::deque<std::pair<Key, Eigen::Vector3d>> open = {{{0, 0}, start}};
    std::set<Key> seen = {{0, 0}};
    while (!open.empty()) {
      const auto [key, place] = open.front();
      open.pop_front();
      for (const auto& [x, y] : {Key{1, 0}, Key{-1, 0}, Key{0, 1}, Key{0, -1}}) {
        const Key next(key.first + x, key.second + y);
        if (!seen.insert(next).second) continue;
        const auto stand = StandAt(place + kCell_m * Eigen::Vector3d(x, y, 0.0));
        if (!stand) continue;
        places.push_back(*stand);
        open.emplace_back(next, *stand);
      }
    }
    return places;
  }

 private:
  using Key = std::pair<int, int>;

  /// As high as the robot, and almost without extent otherwise: distances are those of its middle.
  static sim::RobotShape Slim(sim::RobotShape shape) {
    shape.front_m = shape.back_m = shape.half_width_m = 1e-3;
    return shape;
  }

  std::optional<Eigen::Vector3d> StandAt(const Eigen::Vector3d& near) const {
    const auto floor =
        sim::FloorBelow(*scene_, near + kStep_m * Eigen::Vector3d::UnitZ(), 2.0 * kStep_m);
    if (!floor) return std::nullopt;
    const Eigen::Vector3d place(near.x(), near.y(), *floor);
    const double gap_m = checker_.At(sim::Upright(place), 0.0, radius_m_).static_m;
    if (gap_m < radius_m_) return std::nullopt;
    return place;
  }

  std::shared_ptr<const sim::RayCaster> scene_;
  double radius_m_;
  sim::CollisionChecker checker_;
};

}  // namespace

ReachableGround::ReachableGround(const sim::World& world, const sim::RobotShape& shape,
                                 const Pose& T_world_base)
    : places_(Flood(world, shape).From(T_world_base.translation())) {}

double ReachableGround::area_m2() const {
  return kCell_m * kCell_m * static_cast<double>(places_.size());
}

double ReachableGround::ShareKnown(const OccupancyGrid& map, const Pose& T_map_world) const {
  const auto known =
      std::count_if(places_.begin(), places_.end(), [&](const Eigen::Vector3d& place) {
        const Eigen::Vector3d at = T_map_world * place;
        const Eigen::Vector2i cell = map.CellOf(at.head<2>());
        if (!map.Contains(cell)) return false;
        const std::int8_t value = map.At(cell.x(), cell.y());
        return value != OccupancyGrid::kUnknown && !OccupancyGrid::IsOccupied(value);
      });
  return static_cast<double>(known) / static_cast<double>(places_.size());
}

}  // namespace hv::replay
