#include "path_rounding.h"

#include <algorithm>
#include <cmath>

namespace hv::navigation {
namespace {

constexpr double kSameCorner_m = 1e-4;
constexpr double kTurnStep = 0.2;   // rad
constexpr double kNoCorner = 1e-3;  // rad
constexpr double kSmallestRadius_m = 0.05;

double HeadingOf(const Eigen::Vector2d& way) { return std::atan2(way.y(), way.x()); }

/// Writes a path pose by pose.
class PathWriter {
 public:
  PathWriter(const PlanarPose& start, double step_m) : path_{start}, step_m_(step_m) {}

  const Path& path() const { return path_; }
  const PlanarPose& last() const { return path_.back(); }

  void Turn(double turn) {
    const PlanarPose from = last();
    const int steps = static_cast<int>(std::ceil(std::abs(turn) / kTurnStep));
    for (int i = 1; i <= steps; ++i) path_.push_back({from.position, from.yaw + turn * i / steps});
  }
  void TurnTo(double yaw) { Turn(WrappedAngle(yaw - last().yaw)); }

  void DriveTo(const Eigen::Vector2d& position) {
    const PlanarPose from = last();
    const Eigen::Vector2d way = position - from.position;
    const int steps = static_cast<int>(std::ceil(way.norm() / step_m_));
    for (int i = 1; i <= steps; ++i) path_.push_back({from.position + way * i / steps, from.yaw});
  }

  void Add(const Path& poses) { path_.insert(path_.end(), poses.begin(), poses.end()); }

 private:
  Path path_;
  double step_m_;
};

class Rounder {
 public:
  Rounder(const FreeSpace& space, const std::vector<PlanarPose>& chain, const RoundingRules& rules)
      : space_(space), rules_(rules), writer_(chain.front(), rules.step_m) {
    for (const PlanarPose& pose : chain) {
      const bool moved =
          chain_.empty() || (pose.position - chain_.back().position).norm() > kSameCorner_m;
      if (moved) chain_.push_back(pose);
      last_yaw_ = pose.yaw;
    }
  }

  Path Run() {
    for (std::size_t i = 1; i < chain_.size(); ++i) {
      if (i == 1) writer_.TurnTo(HeadingInto(1));
      if (i + 1 < chain_.size()) {
        Corner(i);
      } else {
        writer_.DriveTo(chain_[i].position);
      }
    }
    if (rules_.keep_last_yaw) writer_.TurnTo(last_yaw_);
    return writer_.path();
  }

 private:
  double HeadingInto(std::size_t i) const {
    return HeadingOf(chain_[i].position - chain_[i - 1].position);
  }

  void Corner(std::size_t i) {
    const double turn = WrappedAngle(HeadingInto(i + 1) - HeadingInto(i));
    if (std::abs(turn) > kNoCorner && Arc(i, turn)) return;
    writer_.DriveTo(chain_[i].position);
    if (!space_.TurnIsFree(writer_.last(), turn)) writer_.TurnTo(chain_[i].yaw);
    writer_.TurnTo(HeadingInto(i + 1));
  }

  /// Replaces the corner by the widest arc that is free.
  bool Arc(std::size_t i, double turn) {
    const Eigen::Vector2d& corner = chain_[i].position;
    const double before_m = (corner - writer_.last().position).norm();
    const double after_m = 0.5 * (chain_[i + 1].position - corner).norm();
    const double slope = std::tan(0.5 * std::abs(turn));
    double radius_m = std::min(rules_.radius_m, std::min(before_m, after_m) / slope);
    for (; radius_m > kSmallestRadius_m; radius_m *= 0.5) {
      const PlanarPose begin{corner - radius_m * slope * writer_.last().Ahead(),
                             writer_.last().yaw};
      const Path arc = ArcFrom(begin, radius_m, turn);
      const bool free = std::all_of(arc.begin(), arc.end(),
                                    [&](const PlanarPose& pose) { return space_.IsFree(pose); });
      if (!free) continue;
      writer_.DriveTo(begin.position);
      writer_.Add(arc);
      return true;
    }
    return false;
  }

  Path ArcFrom(const PlanarPose& begin, double radius_m, double turn) const {
    const double step_m = std::min(rules_.step_m, 0.5 * space_.grid().grid().resolution_m);
    const double step = std::min(kTurnStep, step_m / std::max(radius_m, kSmallestRadius_m));
    const int steps = static_cast<int>(std::ceil(std::abs(turn) / step));
    const double side = turn > 0.0 ? 1.0 : -1.0;
    Path arc;
    for (int k = 1; k <= steps; ++k) {
      const double angle = std::abs(turn) * k / steps;
      const Eigen::Vector2d along(radius_m * std::sin(angle),
                                  side * radius_m * (1.0 - std::cos(angle)));
      arc.push_back(begin * PlanarPose{along, side * angle});
    }
    return arc;
  }

  const FreeSpace& space_;
  RoundingRules rules_;
  PathWriter writer_;
  std::vector<PlanarPose> chain_;
  double last_yaw_ = 0.0;
};

}  // namespace

Path Rounded(const FreeSpace& space, const std::vector<PlanarPose>& chain,
             const RoundingRules& rules) {
  return Rounder(space, chain, rules).Run();
}

}  // namespace hv::navigation
