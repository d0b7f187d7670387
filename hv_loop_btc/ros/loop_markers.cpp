#include "loop_markers.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

#include "hv_ros/conversions.h"
#include "hv_ros/markers.h"

namespace hv::loop {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr std::size_t kMaxScores = 100;
constexpr double kTextHeight = 0.4;  // [m]

/// Builds the markers of one view.
class MarkerBuilder {
 public:
  explicit MarkerBuilder(const LoopView& view) : view_(view) {
    for (const GraphVertex& vertex : view.placed) {
      positions_[vertex.id] = ToPointMessage(vertex.T_map_imu.translation());
    }
  }

  std::vector<Marker> Build() {
    AddEdges();
    AddCandidates();
    for (const auto& [id, position] : positions_) keyframes_.points.push_back(position);
    std::vector<Marker> markers{std::move(keyframes_), std::move(odometry_), std::move(accepted_),
                                std::move(refused_), std::move(undecided_)};
    const std::vector<Marker> scores = Scores();
    markers.insert(markers.end(), scores.begin(), scores.end());
    return markers;
  }

 private:
  void AddLine(std::uint32_t from, std::uint32_t to, Marker& marker) {
    const auto a = positions_.find(from);
    const auto b = positions_.find(to);
    if (a == positions_.end() || b == positions_.end()) return;
    marker.points.push_back(a->second);
    marker.points.push_back(b->second);
  }

  void AddEdges() {
    for (const GraphEdge& edge : view_.edges) {
      const bool loop = edge.kind == EdgeKind::kLoop;
      if (loop) judged_.insert({edge.from, edge.to});
      AddLine(edge.from, edge.to, !loop ? odometry_ : edge.accepted ? accepted_ : refused_);
    }
  }

  void AddCandidates() {
    for (const LoopCandidate& loop : view_.candidates) {
      const bool aligned = loop.fitness > 0.0;
      if (!aligned || judged_.count({loop.match, loop.query}) != 0) continue;
      AddLine(loop.match, loop.query, loop.reason.empty() ? undecided_ : refused_);
    }
  }

  /// Text in the middle of the newest accepted loops.
  std::vector<Marker> Scores() const {
    std::vector<Marker> texts;
    for (auto loop = view_.candidates.rbegin(); loop != view_.candidates.rend(); ++loop) {
      const auto a = positions_.find(loop->match);
      const auto b = positions_.find(loop->query);
      if (!loop->accepted || a == positions_.end() || b == positions_.end()) continue;
      Marker text = MakeMarker("scores", Marker::TEXT_VIEW_FACING, kTextHeight, Color(1, 1, 1));
      text.id = static_cast<int>(texts.size());
      text.pose.position.x = 0.5 * (a->second.x + b->second.x);
      text.pose.position.y = 0.5 * (a->second.y + b->second.y);
      text.pose.position.z = 0.5 * (a->second.z + b->second.z) + kTextHeight;
      char score[16];
      std::snprintf(score, sizeof(score), "%.2f", loop->score());
      text.text = score;
      texts.push_back(text);
      if (texts.size() == kMaxScores) break;
    }
    return texts;
  }

  const LoopView& view_;
  std::map<std::uint32_t, geometry_msgs::Point> positions_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> judged_;
  Marker keyframes_ = MakeMarker("keyframes", Marker::POINTS, 0.12, Color(0.9F, 0.9F, 1.0F));
  Marker odometry_ = MakeMarker("odometry", Marker::LINE_LIST, 0.05, Color(0.4F, 0.6F, 1.0F));
  Marker accepted_ = MakeMarker("loops_accepted", Marker::LINE_LIST, 0.06, Color(0.1F, 0.9F, 0.2F));
  Marker refused_ =
      MakeMarker("loops_refused", Marker::LINE_LIST, 0.02, Color(1, 0.2F, 0.2F, 0.6F));
  Marker undecided_ =
      MakeMarker("loops_undecided", Marker::LINE_LIST, 0.03, Color(0.6F, 0.6F, 0.6F, 0.8F));
};

}  // namespace

MarkerArray ToLoopMarkers(const LoopView& view, const std::string& frame) {
  MarkerArray array;
  Marker clear;
  clear.action = Marker::DELETEALL;
  array.markers.push_back(clear);
  const std::vector<Marker> markers = MarkerBuilder(view).Build();
  std::copy_if(markers.begin(), markers.end(), std::back_inserter(array.markers),
               [](const Marker& marker) {
                 return marker.type == Marker::TEXT_VIEW_FACING || !marker.points.empty();
               });
  for (Marker& marker : array.markers) marker.header.frame_id = frame;
  return array;
}

}  // namespace hv::loop
