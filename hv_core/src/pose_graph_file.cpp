#include "hv_core/pose_graph_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <unordered_set>
#include <vector>

#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "point_fields.h"

namespace hv {
namespace {

constexpr const char* kVertexTag = "VERTEX_SE3:QUAT";
constexpr const char* kEdgeTag = "EDGE_SE3:QUAT";
/// Comments with this first word are ours and describe the line that follows, or hold an edge.
constexpr const char* kStampMark = "#stamp";
constexpr const char* kOdometryMark = "#odometry";
constexpr const char* kLoopMark = "#loop";
constexpr const char* kRejectedMark = "#rejected";

/// Half angles in the rotation part.
Vector6d HalfRotation() {
  Vector6d scale;
  scale << 1.0, 1.0, 1.0, 0.5, 0.5, 0.5;
  return scale;
}

void Append(std::string& text, double value) {
  char number[32];
  std::snprintf(number, sizeof(number), " %.17g", value);
  text += number;
}

void AppendPose(std::string& text, const Pose& pose) {
  for (int i = 0; i < 3; ++i) Append(text, pose.translation()[i]);
  const Eigen::Quaterniond rotation(pose.linear());
  for (const double value : {rotation.x(), rotation.y(), rotation.z(), rotation.w()}) {
    Append(text, value);
  }
}

std::string EdgeLine(const GraphEdge& edge) {
  std::string line =
      std::string(kEdgeTag) + " " + std::to_string(edge.from) + " " + std::to_string(edge.to);
  AppendPose(line, edge.T_from_to);
  const Matrix6d information = ToG2oInformation(edge.information);
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) Append(line, information(row, column));
  }
  return line + "\n";
}

std::string ToText(const PoseGraphData& graph) {
  std::string text =
      "# Pose graph: vertices are poses of the IMU in the map frame.\n"
      "# '#stamp' and '#loop' describe the next line, '#rejected' lines are edges left out.\n";
  for (const GraphVertex& vertex : graph.vertices) {
    text += std::string(kStampMark) + " " + ToString(vertex.stamp) + "\n" + kVertexTag + " " +
            std::to_string(vertex.id);
    AppendPose(text, vertex.T_map_imu);
    text += "\n";
  }
  for (const GraphEdge& edge : graph.edges) {
    text += edge.kind == EdgeKind::kLoop ? kLoopMark : kOdometryMark;
    text += edge.accepted ? "\n" : std::string("\n") + kRejectedMark + " ";
    text += EdgeLine(edge);
  }
  return text;
}

/// Reads a graph line by line.
class G2oParser {
 public:
  G2oParser(std::string_view text, const std::string& source) : lines_(text), source_(source) {}

  PoseGraphData Parse() {
    std::string_view line;
    while (lines_.Next(line)) Take(SplitWords(line));
    std::sort(graph_.vertices.begin(), graph_.vertices.end(),
              [](const GraphVertex& a, const GraphVertex& b) { return a.id < b.id; });
    CheckReferences();
    return std::move(graph_);
  }

 private:
  using Words = std::vector<std::string_view>;

  void Take(const Words& words) {
    if (words.empty()) return;
    if (words[0] == kStampMark && words.size() == 2) {
      const std::optional<Time> stamp = ParseTime(std::string(words[1]));
      if (!stamp) Fail("bad stamp");
      stamp_ = *stamp;
    } else if (words[0] == kLoopMark || words[0] == kOdometryMark) {
      kind_ = words[0] == kLoopMark ? EdgeKind::kLoop : EdgeKind::kOdometry;
    } else if (words[0] == kRejectedMark) {
      TakeEdge(Words(words.begin() + 1, words.end()), false);
    } else if (words[0] == kVertexTag) {
      TakeVertex(words);
    } else if (words[0] == kEdgeTag) {
      TakeEdge(words, true);
    } else if (words[0].front() != '#' && words[0] != "FIX" && words[0].substr(0, 7) != "PARAMS_") {
      Fail("expected VERTEX_SE3:QUAT or EDGE_SE3:QUAT");
    }
  }

  void TakeVertex(const Words& words) {
    if (words.size() != 9) Fail("a vertex needs an id and 7 numbers");
    GraphVertex vertex;
    vertex.id = Id(words[1]);
    vertex.stamp = stamp_;
    vertex.T_map_imu = ReadPose(Numbers(words, 2));
    if (!ids_.insert(vertex.id).second) Fail("vertex " + std::to_string(vertex.id) + " again");
    graph_.vertices.push_back(vertex);
    stamp_ = Time();
  }

  void TakeEdge(const Words& words, bool accepted) {
    if (words.size() != 31 || words[0] != kEdgeTag) Fail("an edge needs two ids and 28 numbers");
    GraphEdge edge;
    edge.from = Id(words[1]);
    edge.to = Id(words[2]);
    const std::vector<double> numbers = Numbers(words, 3);
    edge.T_from_to = ReadPose(numbers);
    edge.information = ReadInformation(numbers);
    const bool consecutive = edge.from < edge.to && edge.to - edge.from == 1;
    edge.kind = kind_.value_or(consecutive ? EdgeKind::kOdometry : EdgeKind::kLoop);
    edge.accepted = accepted;
    graph_.edges.push_back(edge);
    kind_.reset();
  }

  std::uint32_t Id(std::string_view word) const {
    std::size_t value = 0;
    if (!ParseCount(word, value) || value > std::numeric_limits<std::uint32_t>::max()) {
      Fail("bad vertex id");
    }
    return static_cast<std::uint32_t>(value);
  }

  std::vector<double> Numbers(const Words& words, std::size_t first) const {
    std::vector<double> numbers(words.size() - first);
    for (std::size_t i = first; i < words.size(); ++i) {
      double& number = numbers[i - first];
      if (!ParseDecimal(words[i], number) || !std::isfinite(number)) Fail("bad number");
    }
    return numbers;
  }

  Pose ReadPose(const std::vector<double>& n) const {
    const Eigen::Quaterniond rotation(n[6], n[3], n[4], n[5]);
    const double norm = rotation.norm();
    if (!(norm > 0.9 && norm < 1.1)) Fail("the quaternion does not have length 1");
    return MakePose(rotation.normalized(), Eigen::Vector3d(n[0], n[1], n[2]));
  }

  Matrix6d ReadInformation(const std::vector<double>& numbers) const {
    Matrix6d information;
    std::size_t next = 7;
    for (int row = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column) {
        information(row, column) = information(column, row) = numbers[next++];
      }
    }
    if ((information.diagonal().array() < 0.0).any()) Fail("negative information");
    return FromG2oInformation(information);
  }

  void CheckReferences() const {
    for (const GraphEdge& edge : graph_.edges) {
      for (const std::uint32_t id : {edge.from, edge.to}) {
        if (ids_.count(id) != 0) continue;
        throw InputError(source_ + ": an edge refers to vertex " + std::to_string(id) +
                         ", which is not there");
      }
    }
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(source_ + ":" + std::to_string(lines_.number()) + ": " + what);
  }

  LineReader lines_;
  const std::string source_;
  PoseGraphData graph_;
  std::unordered_set<std::uint32_t> ids_;
  Time stamp_;
  std::optional<EdgeKind> kind_;
};

}  // namespace

Matrix6d ToG2oInformation(const Matrix6d& information) {
  // residual = D^-1 error near zero, so the error's information is D^-1 times ours times D^-1.
  const Vector6d inverse = HalfRotation().cwiseInverse();
  return inverse.asDiagonal() * information * inverse.asDiagonal();
}

Matrix6d FromG2oInformation(const Matrix6d& information) {
  const Vector6d half = HalfRotation();
  return half.asDiagonal() * information * half.asDiagonal();
}

PoseGraphData ReadG2o(const std::string& path) { return ParseG2o(ReadFile(path), path); }

PoseGraphData ParseG2o(std::string_view text, const std::string& source) {
  return G2oParser(text, source).Parse();
}

void WriteG2o(const std::string& path, const PoseGraphData& graph) {
  WriteFile(path, {ToText(graph)});
}

}  // namespace hv
