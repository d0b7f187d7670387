#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hv_core/depth_image.h"
#include "hv_core/scan.h"
#include "hv_navigation/mapping_config.h"

namespace hv::navigation {

/// Pinhole without distortion, as depth cameras deliver rectified images [px].
struct DepthCameraModel {
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
};

/// What became of the pixels of an image.
struct DepthReport {
  bool refused = false;  ///< size and data disagree, or the camera model is of no use
  std::size_t pixels = 0;
  std::size_t without_depth = 0;
  std::size_t out_of_range = 0;
  std::size_t flying = 0;   ///< between two surfaces, on neither
  std::size_t speckle = 0;  ///< in small groups
};

struct DepthCloud {
  std::vector<Point> points;  ///< optical frame: x right, y down, z forward [m]
  DepthReport report;
};

/// Filters a depth image and projects it. Of each tile of `decimation` pixels the nearest gives a
/// point, so that thin obstacles stay. Bad images give no points and say so in the report.
DepthCloud ProjectDepth(const DepthImage& image, const DepthCameraModel& camera,
                        const DepthConfig& config);

}  // namespace hv::navigation
