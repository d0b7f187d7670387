#include "hv_replay/collision_log.h"

#include <cmath>
#include <cstdio>

namespace hv::replay {
namespace {

constexpr double kMoving_mps = 0.02;
constexpr double kMoving_rps = 0.05;

bool Moves(const sim::DriveCommand& velocity) {
  return std::abs(velocity.linear_mps) > kMoving_mps ||
         std::abs(velocity.angular_rps) > kMoving_rps;
}

const char* NameOf(sim::ContactKind kind) {
  switch (kind) {
    case sim::ContactKind::kObstacle:
      return "obstacle";
    case sim::ContactKind::kPerson:
      return "person";
    case sim::ContactKind::kEdge:
      return "edge";
  }
  return "";
}

std::string Row(const sim::Collision& collision, const navigation::PlanarPose& place, int trial) {
  char text[128];
  std::snprintf(text, sizeof(text), ",%d,%s,%.3f,%.3f,%.4f,%.3f,%.3f", trial,
                NameOf(collision.contact.kind), place.position.x(), place.position.y(), place.yaw,
                collision.contact.velocity.linear_mps, collision.contact.velocity.angular_rps);
  return ToString(collision.stamp) + text;
}

}  // namespace

CollisionLog::CollisionLog(const std::string& path)
    : log_(path, "stamp,trial,with,x,y,yaw,linear_mps,angular_rps") {}

void CollisionLog::Note(const DriveCycle& cycle, const Pose& T_map_world, int trial,
                        CollisionCount& count) {
  for (const sim::Collision& collision : cycle.collisions) {
    const sim::Contact& contact = collision.contact;
    const navigation::PlanarPose place = navigation::Planar(T_map_world * contact.T_world_base);
    log_.Append(Row(collision, place, trial));
    if (!Moves(contact.velocity) && contact.kind == sim::ContactKind::kPerson) {
      ++count.hit_by_people;
      continue;
    }
    ++count.collisions;
    count.contacts.push_back(place.position);
  }
}

}  // namespace hv::replay
