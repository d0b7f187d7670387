#pragma once

#include <cstdint>
#include <vector>

#include "hv_core/time.h"

namespace hv {

/// One LiDAR return in the LiDAR frame.
struct Point {
  float x = 0.0F;          ///< [m]
  float y = 0.0F;          ///< [m]
  float z = 0.0F;          ///< [m]
  float intensity = 0.0F;  ///< as the sensor gives it
  float time = 0.0F;       ///< firing time after Scan::stamp [s]
  std::uint16_t ring = 0;  ///< laser number, 0 when unknown
};

/// One sweep of the LiDAR. `stamp` is the firing time of its first point, so every Point::time is
/// >= 0 and the sweep ends at `stamp + duration`.
struct Scan {
  Time stamp;
  double duration = 0.0;  ///< largest Point::time [s]; 0 for clouds that are already deskewed
  std::vector<Point> points;

  Time end() const { return stamp + duration; }
};

}  // namespace hv
