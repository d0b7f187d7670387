#include <gtest/gtest.h>

#include "display_cloud.h"
#include "loop_markers.h"

namespace hv::loop {
namespace {

using visualization_msgs::Marker;

GraphVertex VertexAt(std::uint32_t id, double x) {
  return {id, Time::FromSeconds(id), MakePose(Eigen::Quaterniond::Identity(), {x, 0.0, 0.0})};
}

/// A metre of points, a decimetre apart.
PointCloud Metre(std::uint32_t) {
  PointCloud cloud;
  cloud.points.resize(10);
  for (std::size_t i = 0; i < 10; ++i) cloud.points[i].x = 0.05F + 0.1F * static_cast<float>(i);
  return cloud;
}

TEST(DisplayCloud, AddsNewKeyframesAndStartsOverWhenEarlierOnesMove) {
  DisplayCloud cloud(0.1, 1000);
  int loaded = 0;
  const auto load = [&loaded](std::uint32_t id) {
    ++loaded;
    return Metre(id);
  };
  cloud.Update({VertexAt(0, 0.0)}, load);
  EXPECT_EQ(cloud.points().size(), 10U);
  cloud.Update({VertexAt(0, 0.0), VertexAt(1, 0.5)}, load);
  EXPECT_EQ(cloud.points().size(), 15U);
  EXPECT_EQ(loaded, 2);
  cloud.Update({VertexAt(0, 0.0), VertexAt(1, 2.0)}, load);
  EXPECT_EQ(cloud.points().size(), 20U);
  EXPECT_EQ(loaded, 4);
}

TEST(DisplayCloud, IsBounded) {
  DisplayCloud cloud(0.1, 20);
  std::vector<GraphVertex> vertices;
  for (std::uint32_t id = 0; id < 30; ++id) vertices.push_back(VertexAt(id, id));
  cloud.Update(vertices, Metre);
  EXPECT_LE(cloud.points().size(), 20U);
  EXPECT_GE(cloud.points().size(), 8U);
  EXPECT_GT(cloud.points().back().x, 20.0F);
}

LoopView ExampleView() {
  LoopView view;
  for (std::uint32_t id = 0; id < 5; ++id) view.placed.push_back(VertexAt(id, id));
  const auto add_edge = [&view](EdgeKind kind, std::uint32_t from, std::uint32_t to,
                                bool accepted) {
    GraphEdge edge;
    edge.kind = kind;
    edge.from = from;
    edge.to = to;
    edge.accepted = accepted;
    view.edges.push_back(edge);
  };
  for (std::uint32_t id = 1; id < 5; ++id) add_edge(EdgeKind::kOdometry, id - 1, id, true);
  add_edge(EdgeKind::kLoop, 0, 4, true);
  add_edge(EdgeKind::kLoop, 1, 4, false);
  const auto add_candidate = [&view](std::uint32_t match, double fitness, const char* reason) {
    LoopCandidate loop;
    loop.match = match;
    loop.query = 4;
    loop.fitness = loop.overlap = fitness;
    loop.reason = reason;
    loop.accepted = match == 0;
    view.candidates.push_back(loop);
  };
  add_candidate(0, 0.9, "");
  add_candidate(1, 0.7, "");
  add_candidate(2, 0.5, "submaps do not fit");
  add_candidate(3, 0.8, "");
  add_candidate(3, 0.0, "planes do not overlap");
  return view;
}

TEST(LoopMarkers, ShowWhatBecameOfEachCandidate) {
  const auto array = ToLoopMarkers(ExampleView(), "map");
  std::map<std::string, std::size_t> points;
  std::vector<std::string> texts;
  EXPECT_EQ(array.markers.front().action, Marker::DELETEALL);
  for (const Marker& marker : array.markers) {
    EXPECT_EQ(marker.header.frame_id, "map");
    points[marker.ns] += marker.points.size();
    if (!marker.text.empty()) texts.push_back(marker.text);
  }
  EXPECT_EQ(points["keyframes"], 5U);
  EXPECT_EQ(points["odometry"], 8U);
  EXPECT_EQ(points["loops_accepted"], 2U);
  EXPECT_EQ(points["loops_refused"], 4U);
  EXPECT_EQ(points["loops_undecided"], 2U);
  EXPECT_EQ(texts, std::vector<std::string>{"0.81"});
}

TEST(LoopMarkers, KeyframesWithoutAPlaceAreNotDrawn) {
  LoopView view = ExampleView();
  view.placed.resize(1);
  for (const Marker& marker : ToLoopMarkers(view, "map").markers) {
    EXPECT_LE(marker.points.size(), 1U) << marker.ns;
  }
}

}  // namespace
}  // namespace hv::loop
