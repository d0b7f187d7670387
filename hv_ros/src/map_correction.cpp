#include "hv_ros/map_correction.h"

namespace hv {
namespace {

Pose Between(const Pose& from, const Pose& to, double share) {
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond(from.linear()).slerp(share, Eigen::Quaterniond(to.linear()));
  return MakePose(rotation,
                  Eigen::Vector3d((1.0 - share) * from.translation() + share * to.translation()));
}

}  // namespace

void MapCorrection::JumpTo(const Pose& T_map_odom) {
  pending_.reset();
  movement_.reset();
  T_map_odom_ = T_map_odom;
}

Pose MapCorrection::At(Time stamp, const Pose& T_odom_body) {
  if (pending_) {
    // A movement that is under way is left at the value published last.
    movement_ = Movement{stamp, T_odom_body, T_map_odom_, *pending_};
    pending_.reset();
  }
  if (!movement_) return T_map_odom_;
  const double elapsed = stamp - movement_->start;
  if (elapsed < 0.0 || elapsed >= duration_s_) {
    JumpTo(Pose(movement_->to));
    return T_map_odom_;
  }
  const Pose body = Between(movement_->from * movement_->T_odom_body,
                            movement_->to * movement_->T_odom_body, elapsed / duration_s_);
  T_map_odom_ = body * movement_->T_odom_body.inverse();
  return T_map_odom_;
}

}  // namespace hv
