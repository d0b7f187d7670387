#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hv_core/config.h"
#include "hv_core/pose_graph_data.h"

namespace hv::loop {

struct IndexedGraph;

struct PoseGraphConfig {
  int max_iterations = 30;
  double relative_tolerance = 1e-5;
  double inlier_probability = 0.999;
  double inlier_scale = 1.5;
  double odometry_gate_scale = 4.0;
  int loops_to_join_segments = 2;
  double tilt_sigma_deg = 1.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What an optimisation did.
struct PoseGraphSummary {
  bool converged = false;
  bool judged_all_loops = false;  ///< false: the new loops agreed with the map at once
  int iterations = 0;             ///< of solves over all keyframes
  double initial_cost = 0.0;      ///< half the sum of squared residuals, after the choice of loops
  double final_cost = 0.0;
  double seconds = 0.0;
  std::size_t loops_accepted = 0;
  std::size_t loops_refused = 0;
  std::string reason;  ///< one line for logs
};

/// Robust pose graph over keyframes (paper Eq. 4-10): the poses T_map_imu that agree best with
/// odometry between consecutive keyframes and with those loops that are consistent with each other
/// and with odometry.
///
/// Loops are judged by truncated least squares, minimised by graduated non-convexity: one whose
/// squared Mahalanobis residual stays beyond `inlier_scale`^2 times the chi-square quantile of
/// `inlier_probability` (6 degrees of freedom) has no influence and is marked as not accepted. It
/// stays in the graph and is judged again when new loops disagree with the map.
///
/// Keyframes in a chain of odometry edges form a segment. A segment is joined to an earlier one
/// when `loops_to_join_segments` loops between the two agree; it moves there as a whole, and only
/// then do its loops to the other count. Of segments that are joined, the first keyframe is held.
///
/// Deterministic; not thread-safe. What is wrong with a vertex or edge is thrown as InputError and
/// leaves the graph as it was.
class PoseGraph {
 public:
  explicit PoseGraph(const PoseGraphConfig& config = PoseGraphConfig()) : config_(config) {}

  /// Adds a keyframe; ids must grow. When optimised for the first time, keyframes start where
  /// odometry leads: the guess matters for the first of a segment, and until then.
  void AddVertex(std::uint32_t id, Time stamp, const Pose& T_map_imu_guess);

  /// Says where up is at a keyframe: direction against gravity in its IMU frame, any length. Needs
  /// maps whose z axis is vertical, and keeps them so.
  void AddTilt(std::uint32_t id, const Eigen::Vector3d& up_imu);

  /// Adds an odometry edge, from an earlier keyframe to a later one and at most one to and from
  /// each, or a loop between any two. The information must be symmetric and positive semidefinite.
  /// `accepted` is overwritten: loops wait for Optimize().
  void AddEdge(const GraphEdge& edge);

  PoseGraphSummary Optimize();

  std::size_t size() const { return vertices_.size(); }
  bool Contains(std::uint32_t id) const { return index_.count(id) != 0; }

  /// Throws InputError for an unknown id.
  const Pose& pose(std::uint32_t id) const;

  /// By increasing id.
  const std::vector<GraphVertex>& Poses() const { return vertices_; }

  /// In the order of AddEdge().
  const std::vector<GraphEdge>& edges() const { return edges_; }

  /// What is saved. Tilts are not: they come with the keyframes.
  PoseGraphData ToData() const { return {vertices_, edges_}; }

  /// A graph that counts as optimised: the next Optimize() only judges what has been added since.
  static PoseGraph FromData(const PoseGraphData& data,
                            const PoseGraphConfig& config = PoseGraphConfig());

 private:
  struct VertexState {
    bool optimized = false;
    bool has_edge_to = false;
    bool has_edge_from = false;
    std::optional<Eigen::Vector3d> up_imu;  ///< unit vector
  };

  std::size_t Index(std::uint32_t id, const std::string& context) const;
  void CheckOdometry(const GraphEdge& edge, const std::string& name) const;
  IndexedGraph Indexed() const;
  void TakeResult(const IndexedGraph& graph);

  PoseGraphConfig config_;
  std::vector<GraphVertex> vertices_;
  std::vector<VertexState> states_;  // of vertices_
  std::map<std::uint32_t, std::size_t> index_;
  std::vector<GraphEdge> edges_;
  std::size_t first_fresh_edge_ = 0;  // earlier ones have been through Optimize()
};

}  // namespace hv::loop
