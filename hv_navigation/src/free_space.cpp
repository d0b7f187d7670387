#include "free_space.h"

#include <algorithm>
#include <cmath>

namespace hv::navigation {
namespace {

constexpr double kSamePoint_m = 1e-6;

}  // namespace

TurnDriveTurn Between(const PlanarPose& from, const PlanarPose& to) {
  TurnDriveTurn motion;
  const Eigen::Vector2d way = to.position - from.position;
  motion.length_m = way.norm();
  motion.heading = motion.length_m > kSamePoint_m ? std::atan2(way.y(), way.x()) : to.yaw;
  motion.first_turn = WrappedAngle(motion.heading - from.yaw);
  motion.last_turn = WrappedAngle(to.yaw - motion.heading);
  return motion;
}

FreeSpace::FreeSpace(const ClearanceGrid& grid, const Footprint& footprint,
                     const NearnessCost& cost)
    : grid_(grid),
      footprint_(footprint),
      near_footprint_(footprint),
      cost_(cost),
      inscribed_m_(footprint.InscribedRadius()) {
  // What is found free at some poses is then free at those between, which see other parts of cells.
  footprint_.margin_m += 0.25 * grid.grid().resolution_m;
  circumscribed_m_ = footprint_.CircumscribedRadius();
}

void FreeSpace::AllowNear(const Eigen::Vector2d& position, double radius_m, double margin_m) {
  near_ = position;
  near_radius_m_ = radius_m;
  near_footprint_.margin_m = margin_m;
}

const Footprint& FreeSpace::At(const Eigen::Vector2d& position) const {
  return (position - near_).norm() <= near_radius_m_ ? near_footprint_ : footprint_;
}

double FreeSpace::Roaming(const Eigen::Vector2d& position) const {
  return grid_.ClearanceAt(position) - grid_.grid().resolution_m - circumscribed_m_;
}

bool FreeSpace::IsFree(const PlanarPose& pose) const {
  return !At(pose.position).Collides(grid_, pose);
}

bool FreeSpace::TurnIsFree(const PlanarPose& from, double turn) const {
  if (Roaming(from.position) > 0.0) return true;
  return !At(from.position).CollidesTurning(grid_, from, turn);
}

bool FreeSpace::DriveIsFree(const PlanarPose& from, double length_m) const {
  const Eigen::Vector2d ahead = from.Ahead();
  const double step_m = 0.5 * grid_.grid().resolution_m;
  double driven_m = 0.0;
  while (true) {
    const PlanarPose pose{from.position + driven_m * ahead, from.yaw};
    const double roaming_m = Roaming(pose.position);
    if (roaming_m <= 0.0 && !IsFree(pose)) return false;
    if (driven_m >= length_m) return true;
    driven_m = std::min(length_m, driven_m + std::max(step_m, roaming_m));
  }
}

bool FreeSpace::MotionIsFree(const PlanarPose& from, const PlanarPose& to) const {
  const TurnDriveTurn motion = Between(from, to);
  return DriveIsFree({from.position, motion.heading}, motion.length_m) &&
         TurnIsFree(from, motion.first_turn) &&
         TurnIsFree({to.position, motion.heading}, motion.last_turn);
}

double FreeSpace::NeededClearance(const Eigen::Vector2d& position) const {
  return (position - near_).norm() <= near_radius_m_ ? near_footprint_.InscribedRadius()
                                                     : inscribed_m_;
}

double FreeSpace::Nearness(double clearance_m) const {
  const double depth = 1.0 - (clearance_m - inscribed_m_) / cost_.soft_m;
  const double bounded = std::clamp(depth, 0.0, 1.0);
  return cost_.weight * bounded * bounded;
}

double FreeSpace::DriveCost(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  const double length_m = (to - from).norm();
  if (length_m <= 0.0 || cost_.weight <= 0.0) return length_m;
  const Eigen::Vector2d ahead = (to - from) / length_m;
  const double soft_m = inscribed_m_ + cost_.soft_m;
  const double step_m = 2.0 * grid_.grid().resolution_m;
  double cost = length_m;
  for (double driven_m = 0.0; driven_m < length_m;) {
    const Eigen::Vector2d at = from + driven_m * ahead;
    const double clearance_m = grid_.ClearanceAt(at);
    // Far from obstacles nothing is to be added for a while.
    const double next_m = std::max(step_m, clearance_m - soft_m);
    if (clearance_m < soft_m) {
      cost += std::min(next_m, length_m - driven_m) * Nearness(clearance_m);
    }
    driven_m += next_m;
  }
  return cost;
}

}  // namespace hv::navigation
