#include <algorithm>
#include <map>

#include "hv_loop_btc/loop_closer.h"
#include "hv_loop_btc/submap_file.h"

namespace hv::loop {
namespace {

/// Way between two sessions: beyond what LoopGate restricts anything by.
constexpr double kUnknownWay_m = 1e5;

/// Odometry edges by the keyframe they lead to.
std::map<std::uint32_t, const GraphEdge*> OdometryInto(const PoseGraphData& data) {
  std::map<std::uint32_t, const GraphEdge*> edges;
  for (const GraphEdge& edge : data.edges) {
    if (edge.kind == EdgeKind::kOdometry) edges[edge.to] = &edge;
  }
  return edges;
}

}  // namespace

std::uint32_t LoopCloser::Restore(const PoseGraphData& data, const StoredSubmaps& submaps) {
  if (graph_.size() > 0) throw InputError("a map can only be loaded before the first keyframe");
  graph_ = PoseGraph::FromData(data, config_.graph);
  const auto odometry_into = OdometryInto(data);
  std::uint32_t segments = 0;
  const Track* before = nullptr;
  for (const GraphVertex& vertex : data.vertices) {
    const Eigen::Vector3d up_imu = vertex.T_map_imu.linear().transpose().col(2);
    Track track{vertex.stamp, vertex.T_map_imu, up_imu, 0.0, segments};
    const auto edge = odometry_into.find(vertex.id);
    if (edge != odometry_into.end()) {
      const Track& from = tracks_.at(edge->second->from);
      track.T_odom_imu = from.T_odom_imu * edge->second->T_from_to;
      track.segment = from.segment;
      odometry_.push_back(*edge->second);
    } else {
      ++segments;
      track.segment = segments - 1;
    }
    if (before != nullptr) {
      const Pose step = before->T_odom_imu.inverse() * track.T_odom_imu;
      track.travelled_m = before->travelled_m + step.translation().norm();
    }
    graph_.AddTilt(vertex.id, up_imu);
    before = &(tracks_[vertex.id] = track);
  }
  detector_.Restore(submaps);
  StartSession();
  return segments;
}

void LoopCloser::StartSession() {
  if (tracks_.empty()) return;
  submaps_.Finish();
  session_start_ = tracks_.rbegin()->first + 1;
  session_travelled_m_ = tracks_.rbegin()->second.travelled_m + kUnknownWay_m;
  T_map_odom_ = Pose::Identity();
  last_.reset();
}

bool LoopCloser::Joined() const {
  const auto& edges = graph_.edges();
  return session_start_ == 0 || std::any_of(edges.begin(), edges.end(), [this](const auto& edge) {
           return edge.kind == EdgeKind::kLoop && edge.accepted && edge.from < session_start_ &&
                  edge.to >= session_start_;
         });
}

std::vector<GraphVertex> LoopCloser::PlacedVertices() const {
  std::vector<GraphVertex> placed = graph_.Poses();
  if (Joined()) return placed;
  const auto first_unplaced =
      std::find_if(placed.begin(), placed.end(),
                   [this](const auto& vertex) { return vertex.id >= session_start_; });
  placed.erase(first_unplaced, placed.end());
  return placed;
}

}  // namespace hv::loop
