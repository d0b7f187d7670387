#include "join_attempt.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hv_core/angles.h"
#include "hv_loop_btc/pose_graph_residuals.h"

namespace hv::loop {
namespace {

/// Share of the work up to the first optimisation.
constexpr double kAnywhereShare = 0.8;
/// Sessions are not joined when more loops than this share of the accepted ones contradict them.
constexpr double kMostContradiction = 0.75;
/// Floors and walls of different buildings fit each other well. What tells places apart is the
/// pattern of what stands there: joins that are right have a median of 25 common triangles or
/// more over their loops, wrong ones of similar halls up to 13.
constexpr int kLeastTriangles = 20;

template <typename Item>
void Append(const std::vector<Item>& more, std::vector<Item>& items) {
  items.insert(items.end(), more.begin(), more.end());
}

PoseGraphData Both(const PoseGraphData& a, const PoseGraphData& b) {
  PoseGraphData both = a;
  Append(b.vertices, both.vertices);
  Append(b.edges, both.edges);
  return both;
}

/// Saved graphs have no tilts, but their poses are the result of them.
PoseGraph GraphOf(const PoseGraphConfig& config, const PoseGraphData& data) {
  PoseGraph graph = PoseGraph::FromData(data, config);
  for (const GraphVertex& vertex : data.vertices) {
    graph.AddTilt(vertex.id, vertex.T_map_imu.linear().transpose() * Eigen::Vector3d::UnitZ());
  }
  return graph;
}

}  // namespace

JoinAttempt::JoinAttempt(const LoopConfig& config, const SavedSession& map,
                         const SavedSession& added, const SessionJoin::Progress& progress)
    : config_(config),
      map_(map),
      added_(added),
      progress_(progress),
      graph_(GraphOf(config.graph, Both(map.graph, added.graph))),
      own_edges_(graph_.edges().size()) {}

SessionJoinResult JoinAttempt::Run() {
  FindAnywhere();
  graph_.Optimize();
  SessionJoinResult result = Outcome();
  const int triangles = CommonTriangles();
  result.triangles = triangles;
  result.reason = WhyNot(result);
  if (!result.reason.empty()) return result;
  FindNearby();
  graph_.Optimize();
  result = Outcome();
  result.triangles = triangles;
  result.joined = true;
  Report(1.0);
  return result;
}

void JoinAttempt::FindAnywhere() {
  SessionSearch search(config_, map_, added_, SessionSearch::Guess::kNone);
  LoopVote vote(config_.vote);
  const auto& records = added_.submaps.records;
  for (std::size_t i = 0; i < records.size(); ++i) {
    Vote(records[i], search, vote, std::numeric_limits<double>::infinity());
    descriptors_.push_back(search.descriptor());
    Report(kAnywhereShare * static_cast<double>(i + 1) / static_cast<double>(records.size()));
  }
}

/// Backwards, since the first submap asked for is not compared with the newest ones of the map.
void JoinAttempt::FindNearby() {
  SessionSearch search(config_, map_, added_, SessionSearch::Guess::kNear);
  LoopVote vote(config_.vote);
  const std::set<std::uint32_t> located = Located();
  const double reach = search.loop_distance_m() + config_.gate.base_translation_m;
  const auto& records = added_.submaps.records;
  for (std::size_t i = records.size(); i-- > 0;) {
    Report(1.0 -
           (1.0 - kAnywhereShare) * static_cast<double>(i) / static_cast<double>(records.size()));
    if (located.count(records[i].keyframe) != 0 || !IsNear(records[i], reach)) continue;
    Vote(records[i], search, vote, 0.0);
  }
}

void JoinAttempt::Vote(const SubmapRecord& record, SessionSearch& search, LoopVote& vote,
                       double uncertainty_m) {
  const SessionSearch::Poses poses = [this](std::uint32_t id) { return graph_.pose(id); };
  const std::vector<LoopCandidate> candidates = search.Find(record, poses);
  fitting_ += std::any_of(candidates.begin(), candidates.end(),
                          [](const LoopCandidate& one) { return one.reason.empty(); })
                  ? 1
                  : 0;
  for (const LoopCandidate& loop :
       vote.Add(candidates, {uncertainty_m, 0.0, search.confirm_score(), poses})) {
    graph_.AddEdge(LoopEdge(config_, loop));
    triangles_.push_back(loop.inliers);
  }
}

void JoinAttempt::Report(double share) const {
  if (progress_) progress_(share);
}

bool JoinAttempt::IsNear(const SubmapRecord& record, double distance_m) const {
  const Eigen::Vector3d here = graph_.pose(record.keyframe).translation();
  const auto& places = map_.submaps.records;
  return std::any_of(places.begin(), places.end(), [&](const SubmapRecord& place) {
    return (graph_.pose(place.keyframe).translation() - here).norm() < distance_m;
  });
}

/// Submaps of the added session that an accepted loop holds.
std::set<std::uint32_t> JoinAttempt::Located() const {
  std::set<std::uint32_t> located;
  for (std::size_t i = own_edges_; i < graph_.edges().size(); ++i) {
    if (graph_.edges()[i].accepted) located.insert(graph_.edges()[i].to);
  }
  return located;
}

SessionJoinResult JoinAttempt::Outcome() const {
  SessionJoinResult result;
  double squared_m = 0.0;
  double squared_rad = 0.0;
  for (std::size_t i = own_edges_; i < graph_.edges().size(); ++i) {
    const GraphEdge& edge = graph_.edges()[i];
    ++(edge.accepted ? result.loops : result.refused);
    if (!edge.accepted) continue;
    const Vector6d residual =
        RelativePoseResidual(edge.T_from_to, graph_.pose(edge.from), graph_.pose(edge.to));
    squared_m += residual.head<3>().squaredNorm();
    squared_rad += residual.tail<3>().squaredNorm();
  }
  if (result.loops == 0) return result;
  result.residual_m = std::sqrt(squared_m / static_cast<double>(result.loops));
  result.residual_deg =
      kDegreesPerRadian * std::sqrt(squared_rad / static_cast<double>(result.loops));
  return result;
}

/// Median number of triangles that the accepted loops have in common; 0 without loops.
int JoinAttempt::CommonTriangles() const {
  std::vector<int> common;
  for (std::size_t k = 0; k < triangles_.size(); ++k) {
    if (graph_.edges()[own_edges_ + k].accepted) common.push_back(triangles_[k]);
  }
  if (common.empty()) return 0;
  const auto middle = common.begin() + static_cast<std::ptrdiff_t>(common.size() / 2);
  std::nth_element(common.begin(), middle, common.end());
  return *middle;
}

/// Empty when the loops of the first search join the sessions.
std::string JoinAttempt::WhyNot(const SessionJoinResult& result) const {
  const std::string submaps = std::to_string(added_.submaps.records.size()) + " submaps";
  if (fitting_ == 0) return "none of its " + submaps + " fits a place there";
  if (result.loops + result.refused == 0) {
    return std::to_string(fitting_) + " of its " + submaps +
           " fit places there, but they do not agree on where it lies";
  }
  if (result.loops == 0) {
    return "the " + std::to_string(result.refused) + " loops that were found contradict the maps";
  }
  const double most = kMostContradiction * static_cast<double>(result.loops);
  if (static_cast<double>(result.refused) > most) {
    return std::to_string(result.loops) + " loops say where it lies, " +
           std::to_string(result.refused) + " say otherwise";
  }
  if (result.triangles < kLeastTriangles) {
    return "a place like it is there, but what stands in it differs (" +
           std::to_string(result.triangles) + " common triangles, " +
           std::to_string(kLeastTriangles) + " needed)";
  }
  return "";
}

SavedSession JoinAttempt::Joined() const {
  SavedSession joined = map_;
  joined.graph = graph_.ToData();
  joined.clouds.insert(added_.clouds.begin(), added_.clouds.end());
  Append(added_.submaps.records, joined.submaps.records);
  const bool same_scale = added_.submaps.scale == map_.submaps.scale;
  Append(same_scale ? added_.submaps.descriptors : descriptors_, joined.submaps.descriptors);
  return joined;
}

}  // namespace hv::loop
