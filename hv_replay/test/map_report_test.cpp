#include "hv_replay/map_report.h"

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "hv_core/map_writer.h"

namespace hv::replay {
namespace {

class MapReportTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "/hv_report_XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string folder_;
};

std::vector<Point> TwoPoints() {
  std::vector<Point> points(2);
  points[0].x = -1.0F;
  points[1].y = 4.0F;
  return points;
}

TEST_F(MapReportTest, CountsWhatAMapHolds) {
  PoseGraphData graph;
  graph.vertices.push_back({0, Time::FromSeconds(5.0), Pose::Identity()});
  graph.vertices.push_back({1, Time::FromSeconds(7.5), Pose(Eigen::Translation3d(3.0, 0.0, 0.0))});
  graph.edges.resize(3);
  for (GraphEdge& edge : graph.edges) edge.to = 1;
  graph.edges[1].kind = graph.edges[2].kind = EdgeKind::kLoop;
  graph.edges[2].accepted = false;
  MapWriter writer(folder_ + "/map");
  writer.AddGraph(graph);
  writer.AddCloud(TwoPoints());
  writer.Commit("a: 1\n");
  const MapReport report = ReportMap(MapFolder::Open(folder_ + "/map"));
  EXPECT_EQ(report.manifest.loops, 1U);
  EXPECT_EQ(report.loops_rejected, 1U);
  EXPECT_DOUBLE_EQ(report.path_length_m, 3.0);
  EXPECT_DOUBLE_EQ(report.duration_s, 2.5);
  EXPECT_EQ(report.cloud_points, 2U);
  EXPECT_EQ(report.lower, Eigen::Vector3d(-1.0, 0.0, 0.0));
  EXPECT_EQ(report.upper, Eigen::Vector3d(0.0, 4.0, 0.0));
  EXPECT_NE(MapReportJson(report).ToString().find("\"parts\": [\"cloud\", \"graph\"]"),
            std::string::npos);
  EXPECT_NE(MapReportText(report).find("1 accepted, 1 rejected"), std::string::npos);
}

TEST_F(MapReportTest, PlainCloudsHaveNoManifest) {
  WritePcd(folder_ + "/a.pcd", TwoPoints());
  const MapReport report = ReportMap(MapFolder::Open(folder_ + "/a.pcd"));
  EXPECT_TRUE(report.plain_cloud);
  EXPECT_EQ(report.cloud_points, 2U);
  EXPECT_EQ(MapReportText(report).find("format"), std::string::npos);
}

}  // namespace
}  // namespace hv::replay
