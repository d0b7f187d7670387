#include "hv_loop_btc/loop_closer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hv_loop_btc/submap_file.h"

namespace hv::loop {
namespace {

LoopConfig Checked(const LoopConfig& config) {
  ConfigProblems problems;
  config.Validate(problems);
  if (!problems.lines().empty()) throw InputError("configuration: " + problems.lines().front());
  return config;
}

}  // namespace

void LoopConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("loop_sigma_m", loop_sigma_m, "standard deviation of a perfect loop (Eq. 10) [m]");
  visitor.Field("loop_sigma_deg", loop_sigma_deg, "the same for rotation [deg]");
  visitor.Section("submap", submap, "consecutive keyframes as one cloud");
  visitor.Section("btc", btc, "boundary triangle descriptors");
  visitor.Section("detector", detector, "search for candidates");
  visitor.Section("registration", registration, "fine alignment of submaps");
  visitor.Section("gate", gate, "what odometry allows");
  visitor.Section("vote", vote, "which candidates are loops");
  visitor.Section("odometry", odometry, "edges between consecutive keyframes");
  visitor.Section("graph", graph, "pose graph");
  visitor.Section("store", store, "clouds of keyframes on disk");
}

void LoopConfig::Validate(ConfigProblems& problems) const {
  problems.Require(loop_sigma_m > 0.0, "loop.loop_sigma_m", "must be positive");
  problems.Require(loop_sigma_deg > 0.0, "loop.loop_sigma_deg", "must be positive");
  submap.Validate(problems);
  btc.Validate(problems);
  detector.Validate(problems);
  registration.Validate(problems);
  gate.Validate(problems);
  vote.Validate(problems);
  odometry.Validate(problems);
  graph.Validate(problems);
  store.Validate(problems);
}

GraphEdge LoopEdge(const LoopConfig& config, const LoopCandidate& loop) {
  GraphEdge edge;
  edge.kind = EdgeKind::kLoop;
  edge.from = loop.match;
  edge.to = loop.query;
  edge.T_from_to = loop.T_match_query;
  const double sigma_rad = config.loop_sigma_deg * M_PI / 180.0;
  Vector6d weights;
  weights.head<3>().setConstant(1.0 / (config.loop_sigma_m * config.loop_sigma_m));
  weights.tail<3>().setConstant(1.0 / (sigma_rad * sigma_rad));
  edge.information = loop.score() * weights.asDiagonal().toDenseMatrix();
  return edge;
}

LoopCloser::LoopCloser(const LoopConfig& config, KeyframeStore& store)
    : config_(Checked(config)),
      store_(store),
      submaps_(config_.submap),
      detector_(config_.detector, config_.btc, config_.registration, config_.gate,
                [this](const SubmapRecord& record) { return CloudOf(record); }),
      gate_(config_.gate),
      vote_(config_.vote),
      odometry_model_(config_.odometry),
      graph_(config_.graph) {}

LoopUpdate LoopCloser::Add(const Keyframe& keyframe) {
  store_.Append(keyframe);
  AddToGraph(keyframe);
  return Process(submaps_.Add(keyframe));
}

LoopUpdate LoopCloser::Finish() {
  const LoopUpdate update = Process(submaps_.Finish());
  for (LoopCandidate& candidate : candidates_) {
    if (candidate.accepted || !candidate.reason.empty()) continue;
    candidate.reason = "not confirmed by other submaps, or contradicted by other loops";
  }
  return update;
}

void LoopCloser::AddToGraph(const Keyframe& keyframe) {
  odometry_model_.AddKeyframe(keyframe);
  Track track{keyframe.stamp, keyframe.T_odom_imu, UpInImu(keyframe), session_travelled_m_,
              keyframe.segment};
  Pose T_map_imu = T_map_odom_ * keyframe.T_odom_imu;
  std::optional<GraphEdge> edge;
  if (last_) {
    const Pose step = last_->T_odom_imu.inverse() * keyframe.T_odom_imu;
    track.travelled_m = tracks_.at(last_->id).travelled_m + step.translation().norm();
    if (last_->segment == keyframe.segment) {
      odometry_.push_back(OdometryEdge(config_.odometry, *last_, keyframe));
      edge = odometry_model_.Corrected(odometry_.back());
      T_map_imu = graph_.pose(last_->id) * edge->T_from_to;
      if (Joined()) T_map_odom_ = T_map_imu * keyframe.T_odom_imu.inverse();
    }
  }
  graph_.AddVertex(keyframe.id, keyframe.stamp, T_map_imu);
  graph_.AddTilt(keyframe.id, track.up_imu);
  if (edge) graph_.AddEdge(*edge);
  tracks_[keyframe.id] = track;
  last_ = keyframe;
  last_->points = {};
}

LoopPrior LoopCloser::Prior(const Submap& submap) const {
  LoopPrior prior;
  prior.T_map_keyframe = [this](std::uint32_t id) { return graph_.pose(id); };
  prior.T_map_query = graph_.pose(submap.keyframe);
  prior.travelled_m = tracks_.at(submap.keyframe).travelled_m;
  prior.travelled_at_loop_m = travelled_at_loop_m_;
  return prior;
}

std::vector<Eigen::Vector3f> LoopCloser::CloudOf(const SubmapRecord& record) const {
  const auto load = [this](std::uint32_t id) { return store_.Load(id).points; };
  return SubmapCloud(record.members, load, config_.submap.leaf_m);
}

LoopUpdate LoopCloser::Process(const std::optional<Submap>& submap) {
  LoopUpdate update;
  if (!submap) return update;
  const LoopPrior prior = Prior(*submap);
  update.candidates = detector_.Detect(*submap, prior);
  update.detection = detector_.timing();
  const double unheld_m = std::max(0.0, prior.travelled_m - prior.travelled_at_loop_m);
  const std::vector<LoopCandidate> loops =
      vote_.Add(update.candidates,
                {gate_.LimitsAfter(unheld_m).translation_m, odometry_model_.ExpectedError(unheld_m),
                 detector_.confirm_score(), prior.T_map_keyframe});
  AddLoops(loops);
  candidates_.insert(candidates_.end(), update.candidates.begin(), update.candidates.end());
  if (loops.empty()) return update;
  update.graph = graph_.Optimize();
  update.optimized = true;
  if (Joined()) T_map_odom_ = graph_.pose(last_->id) * last_->T_odom_imu.inverse();
  TakeVerdicts(update.candidates);
  return update;
}

void LoopCloser::AddLoop(const LoopCandidate& loop) {
  graph_.AddEdge(LoopEdge(config_, loop));
  odometry_model_.AddLoop(loop.match, loop.query, loop.T_match_query);
}

void LoopCloser::AddLoops(const std::vector<LoopCandidate>& loops) {
  for (const LoopCandidate& loop : loops) AddLoop(loop);
  if (!loops.empty() && odometry_model_.Learn()) WeighOdometryAnew();
}

void LoopCloser::WeighOdometryAnew() {
  PoseGraph graph(config_.graph);
  for (const GraphVertex& vertex : graph_.Poses()) {
    graph.AddVertex(vertex.id, vertex.stamp, vertex.T_map_imu);
    graph.AddTilt(vertex.id, tracks_.at(vertex.id).up_imu);
  }
  for (const GraphEdge& edge : odometry_) graph.AddEdge(odometry_model_.Corrected(edge));
  for (const GraphEdge& edge : graph_.edges()) {
    if (edge.kind == EdgeKind::kLoop) graph.AddEdge(edge);
  }
  graph_ = std::move(graph);
}

void LoopCloser::TakeVerdicts(std::vector<LoopCandidate>& fresh) {
  std::multimap<std::pair<std::uint32_t, std::uint32_t>, const GraphEdge*> judged;
  const bool joined = Joined();
  for (const GraphEdge& edge : graph_.edges()) {
    if (edge.kind != EdgeKind::kLoop) continue;
    judged.emplace(std::make_pair(edge.from, edge.to), &edge);
    if (!edge.accepted || !joined) continue;
    travelled_at_loop_m_ = std::max(travelled_at_loop_m_, tracks_.at(edge.to).travelled_m);
  }
  const auto mark = [&](LoopCandidate& candidate) {
    if (!candidate.reason.empty()) return;
    const auto [begin, end] = judged.equal_range({candidate.match, candidate.query});
    candidate.accepted = std::any_of(begin, end, [&](const auto& entry) {
      const GraphEdge& edge = *entry.second;
      return edge.accepted && edge.T_from_to.matrix() == candidate.T_match_query.matrix();
    });
  };
  for (LoopCandidate& candidate : candidates_) mark(candidate);
  for (LoopCandidate& candidate : fresh) mark(candidate);
}

std::string LoopCloser::SerializedSubmaps() const {
  StoredSubmaps submaps{detector_.scale_name(), detector_.records(), {}};
  for (std::size_t i = 0; i < detector_.database().size(); ++i) {
    submaps.descriptors.push_back(detector_.database().entry(i));
  }
  return Serialize(submaps);
}

Pose LoopCloser::Corrected(Time stamp, const Pose& T_odom_imu) const {
  const std::vector<GraphVertex>& vertices = graph_.Poses();
  if (vertices.empty()) return T_odom_imu;
  auto after =
      std::lower_bound(vertices.begin(), vertices.end(), stamp,
                       [](const GraphVertex& vertex, Time time) { return vertex.stamp < time; });
  if (after == vertices.end()) --after;
  const auto before = after == vertices.begin() ? after : after - 1;
  const auto carried = [&](const GraphVertex& vertex) -> Pose {
    return vertex.T_map_imu * tracks_.at(vertex.id).T_odom_imu.inverse() * T_odom_imu;
  };
  const double span = after->stamp - before->stamp;
  const double ratio = span > 0.0 ? std::clamp((stamp - before->stamp) / span, 0.0, 1.0) : 0.0;
  const Pose earlier = carried(*before);
  const Pose later = carried(*after);
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond(earlier.linear()).slerp(ratio, Eigen::Quaterniond(later.linear()));
  return MakePose(rotation, Eigen::Vector3d((1.0 - ratio) * earlier.translation() +
                                            ratio * later.translation()));
}

}  // namespace hv::loop
