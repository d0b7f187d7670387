#include "hv_core/pose_graph_file.h"

#include <fstream>
#include <sstream>

#include "small_map.h"

namespace hv {
namespace {

/// Error of g2o's EdgeSE3 as its documentation gives it, written down independently.
Vector6d G2oError(const Pose& measured, const Pose& from, const Pose& to) {
  const Pose delta = measured.inverse() * from.inverse() * to;
  Eigen::Quaterniond rotation(delta.linear());
  if (rotation.w() < 0.0) rotation.coeffs() *= -1.0;
  Vector6d error;
  error << delta.translation(), rotation.vec();
  return error;
}

TEST(PoseGraphFile, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  const PoseGraphData graph = SmallGraph(20, 4);
  WriteG2o(folder / "a.g2o", graph);
  const PoseGraphData back = ReadG2o(folder / "a.g2o");
  ASSERT_EQ(back.vertices.size(), graph.vertices.size());
  ASSERT_EQ(back.edges.size(), graph.edges.size());
  for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
    EXPECT_EQ(back.vertices[i].id, graph.vertices[i].id);
    EXPECT_EQ(back.vertices[i].stamp, graph.vertices[i].stamp);
    EXPECT_TRUE(back.vertices[i].T_map_imu.isApprox(graph.vertices[i].T_map_imu, 1e-14));
  }
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    EXPECT_EQ(back.edges[i].kind, graph.edges[i].kind);
    EXPECT_EQ(back.edges[i].accepted, graph.edges[i].accepted);
    EXPECT_EQ(back.edges[i].from, graph.edges[i].from);
    EXPECT_EQ(back.edges[i].to, graph.edges[i].to);
    EXPECT_TRUE(back.edges[i].T_from_to.isApprox(graph.edges[i].T_from_to, 1e-14));
    EXPECT_EQ(back.edges[i].information, graph.edges[i].information);
  }
}

/// The costs of both conventions agree to second order, with the information of the file read the
/// way g2o reads it: upper triangle, row by row.
TEST(PoseGraphFile, InformationGivesTheSameCostInBothConventions) {
  std::mt19937 random(9);
  for (int trial = 0; trial < 50; ++trial) {
    const Matrix6d ours = RandomInformation(random);
    const Matrix6d theirs = ToG2oInformation(ours);
    const Pose from = RandomPose(random);
    const Pose measured = RandomPose(random);
    const Vector6d small = 1e-5 * se3::Log(RandomPose(random));
    const Pose to = from * measured * se3::Exp(small);
    const Vector6d residual = se3::Log(measured.inverse() * from.inverse() * to);
    const Vector6d error = G2oError(measured, from, to);
    const double cost = residual.dot(ours * residual);
    EXPECT_NEAR(error.dot(theirs * error), cost, 1e-4 * cost);
    EXPECT_EQ(FromG2oInformation(theirs), ours);
  }
}

TEST(PoseGraphFile, LinesFollowTheG2oFormat) {
  const TemporaryFolder folder;
  PoseGraphData graph;
  graph.vertices.push_back({4, Time(), Pose::Identity()});
  graph.vertices.push_back(
      {5, Time(), MakePose(RotationFromRpy(0.0, 0.0, 1.0), Eigen::Vector3d(1.0, 2.0, 3.0))});
  GraphEdge edge;
  edge.from = 4;
  edge.to = 5;
  edge.information = Vector6d(1.0, 2.0, 3.0, 4.0, 5.0, 6.0).asDiagonal();
  graph.edges.push_back(edge);
  WriteG2o(folder / "a.g2o", graph);
  std::ifstream file(folder / "a.g2o");
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    if (line[0] != '#') lines.push_back(line);
  }
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0], "VERTEX_SE3:QUAT 4 0 0 0 0 0 0 1");
  std::istringstream vertex(lines[1]);
  std::string tag;
  double id = 0.0, x = 0.0, y = 0.0, z = 0.0, qx = 0.0, qy = 0.0, qz = 0.0, qw = 0.0;
  vertex >> tag >> id >> x >> y >> z >> qx >> qy >> qz >> qw;
  EXPECT_EQ(z, 3.0);
  EXPECT_NEAR(qz, std::sin(0.5), 1e-15);
  EXPECT_NEAR(qw, std::cos(0.5), 1e-15);
  EXPECT_EQ(lines[2],
            "EDGE_SE3:QUAT 4 5 0 0 0 0 0 0 1 1 0 0 0 0 0 2 0 0 0 0 3 0 0 0 16 0 0 20 0 24");
}

TEST(PoseGraphFile, FilesOfOtherProgramsAreRead) {
  const std::string pose = " 0 0 0 0 0 0 1";
  const std::string information = " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 4 0 0 4 0 4\n";
  const PoseGraphData graph =
      ParseG2o("# comment\nPARAMS_SE3OFFSET 0" + pose + "\nVERTEX_SE3:QUAT 7" + pose +
                   "\nVERTEX_SE3:QUAT 2" + pose + "\r\nVERTEX_SE3:QUAT 3" + pose +
                   "\nFIX 2\n\nEDGE_SE3:QUAT 2 3" + pose + information + "EDGE_SE3:QUAT 7 2" +
                   pose + information,
               "test");
  ASSERT_EQ(graph.vertices.size(), 3U);
  EXPECT_EQ(graph.vertices[0].id, 2U);
  EXPECT_EQ(graph.vertices[2].id, 7U);
  ASSERT_EQ(graph.edges.size(), 2U);
  EXPECT_EQ(graph.edges[0].kind, EdgeKind::kOdometry);
  EXPECT_EQ(graph.edges[1].kind, EdgeKind::kLoop);
  EXPECT_TRUE(graph.edges[1].accepted);
  EXPECT_EQ(graph.edges[0].information, Matrix6d::Identity());
}

TEST(PoseGraphFile, FaultsAreNamedWithTheirLine) {
  const std::string vertex = "VERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n";
  const std::pair<std::string, std::string> cases[] = {
      {"VERTEX_SE2 0 0 0 0\n", "test:2: expected"},
      {"VERTEX_SE3:QUAT 2 0 0 0 0 0 0\n", "test:2: a vertex needs"},
      {"VERTEX_SE3:QUAT -2 0 0 0 0 0 0 1\n", "test:2: bad vertex id"},
      {"VERTEX_SE3:QUAT 5000000000 0 0 0 0 0 0 1\n", "test:2: bad vertex id"},
      {"VERTEX_SE3:QUAT 2 0 0 nan 0 0 0 1\n", "test:2: bad number"},
      {"VERTEX_SE3:QUAT 2 0 0 0 0 0 0 2\n", "test:2: the quaternion"},
      {vertex, "test:2: vertex 1 again"},
      {"#stamp soon\n", "test:2: bad stamp"},
      {"EDGE_SE3:QUAT 1 1 0 0 0 0 0 0 1\n", "test:2: an edge needs"},
      {"#rejected\n", "test:2: an edge needs"},
      {"EDGE_SE3:QUAT 1 1 0 0 0 0 0 0 1 1 0 0 0 0 0 -1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n",
       "test:2: negative information"},
      {"EDGE_SE3:QUAT 1 9 0 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n",
       "test: an edge refers to vertex 9"}};
  for (const auto& [text, expected] : cases) {
    const std::string error = ErrorOf([&text = text, &vertex] { ParseG2o(vertex + text, "test"); });
    EXPECT_EQ(error.rfind(expected, 0), 0U) << "'" << error << "' for " << text;
  }
}

}  // namespace
}  // namespace hv
