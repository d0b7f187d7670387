#pragma once

#include <cstdint>
#include <vector>

#include "hv_core/se3.h"
#include "hv_core/time.h"

namespace hv {

/// Pose of the IMU at a keyframe.
struct GraphVertex {
  std::uint32_t id = 0;  ///< that of the keyframe
  Time stamp;
  Pose T_map_imu = Pose::Identity();
};

enum class EdgeKind { kOdometry, kLoop };

/// Measured relative pose of two keyframes. Its residual is
/// Log(T_from_to^-1 * T_map_from^-1 * T_map_to), translation first (paper Eq. 4-5).
struct GraphEdge {
  EdgeKind kind = EdgeKind::kOdometry;
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  Pose T_from_to = Pose::Identity();
  Matrix6d information = Matrix6d::Identity();  ///< of that residual [1/m^2, 1/rad^2]
  bool accepted = true;  ///< false: a loop that the optimiser judged to be false
};

/// What is saved of a pose graph. Vertices are sorted by id, edges refer to existing vertices.
struct PoseGraphData {
  std::vector<GraphVertex> vertices;
  std::vector<GraphEdge> edges;
};

}  // namespace hv
