#pragma once

#include <cstdint>
#include <vector>

#include "hv_core/time.h"

namespace hv {

/// Depth along the optical axis of each pixel, row by row from the top left.
struct DepthImage {
  Time stamp;
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> depth_mm;  ///< 0: unknown
};

}  // namespace hv
