#include "hv_navigation/path.h"

namespace hv::navigation {

double Length(const Path& path) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length_m += (path[i].position - path[i - 1].position).norm();
  }
  return length_m;
}

std::optional<std::size_t> FirstCollision(const Path& path, const ClearanceGrid& grid,
                                          const Footprint& footprint, std::size_t from,
                                          double distance_m) {
  double driven_m = 0.0;
  for (std::size_t i = from; i < path.size(); ++i) {
    if (i > from) driven_m += (path[i].position - path[i - 1].position).norm();
    if (driven_m > distance_m) break;
    if (footprint.Collides(grid, path[i])) return i;
  }
  return std::nullopt;
}

}  // namespace hv::navigation
