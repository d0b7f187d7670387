#pragma once

#include <optional>

#include <Eigen/Core>

namespace hv::explore {

/// Follows where a robot is: how far it has driven, and when it last got on.
class ProgressWatch {
 public:
  explicit ProgressWatch(double step_m) : step_m_(step_m) {}

  /// A new goal: the time to get on begins again.
  void Restart(double now_s) { got_on_s_ = now_s; }

  /// Jumps, as when the place in the map is corrected, count nothing as driven.
  void Add(const Eigen::Vector2d& position, double now_s) {
    constexpr double kJump_m = 1.0;
    if (last_) {
      const double step = (position - *last_).norm();
      if (step < kJump_m) driven_m_ += step;
    }
    last_ = position;
    if (anchor_ && (position - *anchor_).norm() < step_m_) return;
    anchor_ = position;
    got_on_s_ = now_s;
  }

  double driven_m() const { return driven_m_; }
  double StandsFor(double now_s) const { return now_s - got_on_s_; }

 private:
  double step_m_;
  double driven_m_ = 0.0;
  double got_on_s_ = 0.0;
  std::optional<Eigen::Vector2d> last_;
  std::optional<Eigen::Vector2d> anchor_;  ///< from where getting on is measured
};

}  // namespace hv::explore
