#include "hv_explore_sac/bounds.h"

#include <algorithm>
#include <cmath>

namespace hv::explore {
namespace {

constexpr double kLeastArea_m2 = 1.0;
constexpr double kFarthest_m = 1e5;

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Positive when `c` lies to the left of the way from `a` to `b`.
double Side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return Cross(b - a, c - a);
}

bool Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
           const Eigen::Vector2d& d) {
  return Side(a, b, c) * Side(a, b, d) < 0.0 && Side(c, d, a) * Side(c, d, b) < 0.0;
}

double Area(const std::vector<Eigen::Vector2d>& corners) {
  double twice = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    twice += Cross(corners[i], corners[(i + 1) % corners.size()]);
  }
  return std::abs(twice) / 2.0;
}

}  // namespace

/// By the number of edges to the right of the point.
bool Bounds::Contains(const Eigen::Vector2d& position) const {
  if (everything()) return true;
  bool inside = false;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Eigen::Vector2d& a = corners_[i];
    const Eigen::Vector2d& b = corners_[(i + 1) % corners_.size()];
    if ((a.y() > position.y()) == (b.y() > position.y())) continue;
    const double share = (position.y() - a.y()) / (b.y() - a.y());
    if (position.x() < a.x() + share * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

std::string Bounds::Problem() const {
  if (everything()) return "";
  const bool finite = std::all_of(corners_.begin(), corners_.end(), [](const auto& corner) {
    return corner.allFinite() && corner.norm() < kFarthest_m;
  });
  if (!finite) return "the bounds have corners that are not finite or too far away";
  if (corners_.size() < 3) return "the bounds have fewer than three corners";
  if (CrossesItself()) return "the edges of the bounds cross each other";
  if (Area(corners_) < kLeastArea_m2) return "the bounds enclose less than 1 m^2";
  return "";
}

bool Bounds::CrossesItself() const {
  const std::size_t count = corners_.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 2; k < count; ++k) {
      if (Cross(corners_[i], corners_[(i + 1) % count], corners_[k], corners_[(k + 1) % count])) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace hv::explore
