#include "hv_replay/map_report.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

namespace hv::replay {
namespace {

void ReportCloud(const MapFolder& map, MapReport& report) {
  const PointCloud cloud = map.ReadCloud();
  report.cloud_points = cloud.points.size();
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Point& point = cloud.points[i];
    const Eigen::Vector3d position(point.x, point.y, point.z);
    report.lower = i == 0 ? position : report.lower.cwiseMin(position).eval();
    report.upper = i == 0 ? position : report.upper.cwiseMax(position).eval();
  }
}

/// Along odometry: sessions of a joined map may have run at the same time.
double PathLength(const PoseGraphData& graph) {
  std::map<std::uint32_t, Eigen::Vector3d> positions;
  for (const GraphVertex& vertex : graph.vertices) {
    positions[vertex.id] = vertex.T_map_imu.translation();
  }
  double length = 0.0;
  for (const GraphEdge& edge : graph.edges) {
    if (edge.kind != EdgeKind::kOdometry) continue;
    length += (positions.at(edge.to) - positions.at(edge.from)).norm();
  }
  return length;
}

void ReportGraph(const MapFolder& map, MapReport& report) {
  const PoseGraphData graph = map.ReadGraph();
  for (const GraphEdge& edge : graph.edges) {
    report.loops_rejected += edge.kind == EdgeKind::kLoop && !edge.accepted ? 1 : 0;
  }
  report.path_length_m = PathLength(graph);
  const Trajectory poses = map.ReadPoses();
  if (!poses.empty()) {
    report.duration_s = poses.poses().back().stamp - poses.poses().front().stamp;
  }
}

void ReportGrid(const MapFolder& map, MapReport& report) {
  const OccupancyGrid grid = map.ReadGrid();
  report.grid_resolution_m = grid.resolution_m;
  report.grid_width = grid.width;
  report.grid_height = grid.height;
}

std::vector<std::string> PartNames(const MapContents& contents) {
  const std::pair<bool, const char*> parts[] = {
      {contents.cloud, "cloud"}, {contents.keyframes, "keyframes"},
      {contents.graph, "graph"}, {contents.descriptors, "descriptors"},
      {contents.grid, "grid"},   {contents.occupancy, "occupancy"}};
  std::vector<std::string> names;
  for (const auto& [present, name] : parts) {
    if (present) names.emplace_back(name);
  }
  return names;
}

std::vector<double> ToList(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

template <typename... Values>
std::string Line(const char* format, Values... values) {
  char text[300];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

}  // namespace

MapReport ReportMap(const MapFolder& map) {
  MapReport report;
  report.path = map.path();
  report.plain_cloud = map.is_plain_cloud();
  report.contents = map.contents();
  report.manifest = map.manifest();
  if (report.contents.cloud) ReportCloud(map, report);
  if (report.contents.graph) ReportGraph(map, report);
  if (report.contents.grid) ReportGrid(map, report);
  for (const MapFile& file : report.manifest.files) report.bytes += file.size;
  if (report.plain_cloud) report.bytes = std::filesystem::file_size(map.path());
  return report;
}

JsonObject MapReportJson(const MapReport& report) {
  JsonObject json;
  json.Add("path", report.path).Add("plain_cloud", report.plain_cloud);
  json.Add("parts", PartNames(report.contents));
  if (!report.plain_cloud) {
    json.AddCount("format_version", report.manifest.format_version);
    json.Add("frame", report.manifest.frame);
  }
  json.AddCount("bytes", report.bytes);
  json.AddCount("keyframes", report.manifest.keyframes);
  json.AddCount("loops_accepted", report.manifest.loops);
  json.AddCount("loops_rejected", report.loops_rejected);
  json.Add("path_length_m", report.path_length_m).Add("duration_s", report.duration_s);
  json.AddCount("cloud_points", report.cloud_points);
  json.Add("cloud_lower_m", ToList(report.lower)).Add("cloud_upper_m", ToList(report.upper));
  json.Add("grid_resolution_m", report.grid_resolution_m);
  json.AddCount("grid_width", report.grid_width).AddCount("grid_height", report.grid_height);
  json.Add("configuration", report.manifest.configuration);
  return json;
}

std::string MapReportText(const MapReport& report) {
  std::string parts;
  for (const std::string& name : PartNames(report.contents)) parts += " " + name;
  std::string text = "map          " + report.path + "\nparts       " + parts + "\n";
  text += Line("size         %.1f MB\n", static_cast<double>(report.bytes) * 1e-6);
  if (!report.plain_cloud) {
    text += Line("format       %d\n", report.manifest.format_version);
    text += "frame        " + report.manifest.frame + "\n";
  }
  if (report.contents.graph) {
    text += Line("keyframes    %zu over %.1f m and %.1f s\n", report.manifest.keyframes,
                 report.path_length_m, report.duration_s);
    text += Line("loops        %zu accepted, %zu rejected\n", report.manifest.loops,
                 report.loops_rejected);
  }
  if (report.contents.cloud) {
    const Eigen::Vector3d size = report.upper - report.lower;
    text += Line("cloud        %zu points, %.1f x %.1f x %.1f m\n", report.cloud_points, size.x(),
                 size.y(), size.z());
  }
  if (report.contents.grid) {
    text += Line("grid         %d x %d cells of %.3g m\n", report.grid_width, report.grid_height,
                 report.grid_resolution_m);
  }
  return text;
}

}  // namespace hv::replay
