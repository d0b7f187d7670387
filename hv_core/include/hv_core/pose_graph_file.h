#pragma once

#include <string>
#include <string_view>

#include "hv_core/pose_graph_data.h"

namespace hv {

/// Pose graphs as g2o text (VERTEX_SE3:QUAT, EDGE_SE3:QUAT). What g2o cannot say stands in comment
/// lines, which its readers skip: the stamp of each vertex, which edges are loops, and rejected
/// edges as a whole, so that no other program trusts them. Without such comments stamps are 0,
/// edges between consecutive ids are odometry and all others accepted loops.
///
/// The error of a g2o edge is (translation, vector part of the quaternion) of
/// T_from_to^-1 * T_map_from^-1 * T_map_to; the vector part is half the rotation of GraphEdge's
/// residual. Information is converted so that both give the same cost near zero.

/// Throws InputError naming file and line.
PoseGraphData ReadG2o(const std::string& path);
PoseGraphData ParseG2o(std::string_view text, const std::string& source);

/// Throws InputError when the file cannot be written.
void WriteG2o(const std::string& path, const PoseGraphData& graph);

/// Information of GraphEdge's residual as that of g2o's error, and back.
Matrix6d ToG2oInformation(const Matrix6d& information);
Matrix6d FromG2oInformation(const Matrix6d& information);

}  // namespace hv
