#include "hv_loop_btc/pose_graph.h"

#include <algorithm>

#include <Eigen/Eigenvalues>

#include "robust_optimizer.h"

namespace hv::loop {
namespace {

/// "loop 12 -> 345"
std::string NameOf(const GraphEdge& edge) {
  return std::string(edge.kind == EdgeKind::kLoop ? "loop " : "odometry edge ") +
         std::to_string(edge.from) + " -> " + std::to_string(edge.to);
}

void Require(bool condition, const std::string& what, const std::string& problem) {
  if (!condition) throw InputError("pose graph: " + what + ": " + problem);
}

bool IsRigid(const Pose& pose) {
  constexpr double kTolerance = 1e-6;
  const Eigen::Matrix3d rotation = pose.linear();
  return pose.matrix().allFinite() && rotation.determinant() > 0.0 &&
         (rotation * rotation.transpose()).isIdentity(kTolerance);
}

bool IsSymmetric(const Matrix6d& matrix) {
  constexpr double kTolerance = 1e-6;
  return (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <=
         kTolerance * matrix.cwiseAbs().maxCoeff();
}

bool IsSemidefinite(const Matrix6d& matrix) {
  constexpr double kTolerance = 1e-9;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(matrix, Eigen::EigenvaluesOnly);
  const double largest = solver.eigenvalues().maxCoeff();
  return largest > 0.0 && solver.eigenvalues().minCoeff() >= -kTolerance * largest;
}

Measurement Indexed(const GraphEdge& edge, const std::map<std::uint32_t, std::size_t>& index) {
  return {index.at(edge.from), index.at(edge.to), edge.T_from_to, edge.information};
}

}  // namespace

void PoseGraphConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("max_iterations", max_iterations,
                "most iterations of the solve over all keyframes");
  visitor.Field("relative_tolerance", relative_tolerance,
                "an iteration that lowers the cost by less than this share is the last");
  visitor.Field("inlier_probability", inlier_probability,
                "share of true loops with a squared Mahalanobis residual within the chi-square "
                "quantile that separates true from false loops");
  visitor.Field("inlier_scale", inlier_scale,
                "factor on the residual at that quantile: how much larger errors of loops are than "
                "their information says");
  visitor.Field("odometry_gate_scale", odometry_gate_scale,
                "likewise for the difference between a loop and odometry alone, beyond which a "
                "loop is refused at once");
  visitor.Field("loops_to_join_segments", loops_to_join_segments,
                "loops that must agree before they join two segments of odometry");
  visitor.Field("tilt_sigma_deg", tilt_sigma_deg,
                "standard deviation of the direction of gravity at a keyframe; 0 = not used [deg]");
}

void PoseGraphConfig::Validate(ConfigProblems& problems) const {
  problems.Require(max_iterations >= 1, "pose_graph.max_iterations", "must be at least 1");
  problems.Require(relative_tolerance > 0.0, "pose_graph.relative_tolerance", "must be positive");
  problems.Require(inlier_probability > 0.0 && inlier_probability < 1.0,
                   "pose_graph.inlier_probability", "must lie between 0 and 1");
  problems.Require(inlier_scale > 0.0, "pose_graph.inlier_scale", "must be positive");
  problems.Require(odometry_gate_scale >= inlier_scale, "pose_graph.odometry_gate_scale",
                   "must be at least inlier_scale");
  problems.Require(loops_to_join_segments >= 1, "pose_graph.loops_to_join_segments",
                   "must be at least 1");
  problems.Require(tilt_sigma_deg >= 0.0, "pose_graph.tilt_sigma_deg", "must not be negative");
}

void PoseGraph::AddVertex(std::uint32_t id, Time stamp, const Pose& T_map_imu_guess) {
  const std::string name = "keyframe " + std::to_string(id);
  Require(vertices_.empty() || id > vertices_.back().id, name, "ids must grow");
  Require(IsRigid(T_map_imu_guess), name, "its pose is not a finite rigid transform");
  index_.emplace(id, vertices_.size());
  vertices_.push_back({id, stamp, T_map_imu_guess});
  states_.emplace_back();
}

void PoseGraph::AddTilt(std::uint32_t id, const Eigen::Vector3d& up_imu) {
  const std::string name = "tilt of keyframe " + std::to_string(id);
  VertexState& state = states_[Index(id, name)];
  Require(up_imu.allFinite() && up_imu.norm() > 0.0, name, "has no direction");
  state.has_tilt = true;
  state.up_imu = up_imu.normalized();
}

void PoseGraph::AddEdge(const GraphEdge& edge) {
  const std::string name = NameOf(edge);
  const std::size_t from = Index(edge.from, name);
  const std::size_t to = Index(edge.to, name);
  Require(from != to, name, "joins a keyframe to itself");
  Require(IsRigid(edge.T_from_to), name, "its pose is not a finite rigid transform");
  Require(edge.information.allFinite(), name, "its information is not finite");
  Require(IsSymmetric(edge.information), name, "its information is not symmetric");
  Require(IsSemidefinite(edge.information), name, "its information is not positive semidefinite");
  if (edge.kind == EdgeKind::kOdometry) {
    CheckOdometry(edge, name);
    states_[from].has_edge_from = true;
    states_[to].has_edge_to = true;
  }
  edges_.push_back(edge);
  edges_.back().accepted = edge.kind == EdgeKind::kOdometry;
}

void PoseGraph::CheckOdometry(const GraphEdge& edge, const std::string& name) const {
  Require(edge.from < edge.to, name, "must lead to a later keyframe");
  Require(!states_[Index(edge.from, name)].has_edge_from, name,
          "another odometry edge leaves the first keyframe already");
  Require(!states_[Index(edge.to, name)].has_edge_to, name,
          "another odometry edge leads to the second keyframe already");
}

PoseGraphSummary PoseGraph::Optimize() {
  IndexedGraph graph;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    graph.poses.push_back(vertices_[i].T_map_imu);
    graph.optimized.push_back(states_[i].optimized);
    if (states_[i].has_tilt) graph.tilts.push_back({i, states_[i].up_imu});
  }
  std::vector<std::size_t> loop_edges;
  for (std::size_t k = 0; k < edges_.size(); ++k) {
    const Measurement measurement = Indexed(edges_[k], index_);
    if (edges_[k].kind == EdgeKind::kOdometry) {
      graph.odometry.push_back(measurement);
      continue;
    }
    const LoopState judged = edges_[k].accepted ? LoopState::kAccepted : LoopState::kRefused;
    graph.loops.push_back(measurement);
    graph.states.push_back(k < first_fresh_edge_ ? judged : LoopState::kFresh);
    loop_edges.push_back(k);
  }
  std::sort(graph.odometry.begin(), graph.odometry.end(),
            [](const Measurement& a, const Measurement& b) { return a.to < b.to; });

  const PoseGraphSummary summary = RobustOptimizer(config_, graph).Run();

  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    vertices_[i].T_map_imu = graph.poses[i];
    states_[i].optimized = true;
  }
  for (std::size_t k = 0; k < loop_edges.size(); ++k) {
    edges_[loop_edges[k]].accepted = graph.states[k] == LoopState::kAccepted;
  }
  first_fresh_edge_ = edges_.size();
  return summary;
}

const Pose& PoseGraph::pose(std::uint32_t id) const {
  return vertices_[Index(id, "pose of keyframe " + std::to_string(id))].T_map_imu;
}

PoseGraph PoseGraph::FromData(const PoseGraphData& data, const PoseGraphConfig& config) {
  PoseGraph graph(config);
  for (const GraphVertex& vertex : data.vertices) {
    graph.AddVertex(vertex.id, vertex.stamp, vertex.T_map_imu);
    graph.states_.back().optimized = true;
  }
  for (const GraphEdge& edge : data.edges) {
    graph.AddEdge(edge);
    graph.edges_.back().accepted = edge.accepted;
  }
  graph.first_fresh_edge_ = graph.edges_.size();
  return graph;
}

std::size_t PoseGraph::Index(std::uint32_t id, const std::string& context) const {
  const auto found = index_.find(id);
  Require(found != index_.end(), context, "keyframe " + std::to_string(id) + " is unknown");
  return found->second;
}

}  // namespace hv::loop
