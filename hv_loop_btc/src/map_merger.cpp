#include "hv_loop_btc/map_merger.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

#include "disjoint_sets.h"
#include "hv_core/error.h"
#include "hv_core/map_writer.h"

namespace hv::loop {
namespace {

void Report(const MapMerger::Progress& progress, const std::string& stage, double share) {
  if (progress) progress(stage, share);
}

/// A keyframe in two maps means that they are the same map, or that one holds the other.
void CheckDistinct(const std::vector<MapFolder>& maps) {
  std::unordered_map<std::string, const MapFolder*> owners;
  for (const MapFolder& map : maps) {
    for (const MapFile& file : map.manifest().files) {
      if (file.name.compare(0, 10, "keyframes/") != 0) continue;
      const auto [owner, added] = owners.emplace(file.sha256, &map);
      if (added || owner->second == &map) continue;
      const std::string& other = owner->second->path();
      throw InputError(map.path() +
                       (other == map.path() ? ": is given twice; "
                                            : ": holds " + file.name + " of " + other + "; ") +
                       "the same recording cannot be joined to itself");
    }
  }
}

void Verify(const std::vector<MapFolder>& maps, const MapMerger::Progress& progress) {
  for (const MapFolder& map : maps) {
    if (map.is_plain_cloud()) {
      throw InputError(map.path() + ": is a single cloud; only map folders can be joined");
    }
    map.Verify([&](double share) { Report(progress, "checking " + map.path(), share); });
  }
}

/// Vertices that accepted edges connect to the first one.
std::vector<GraphVertex> Placed(const PoseGraphData& graph) {
  std::map<std::uint32_t, std::size_t> index;
  for (const GraphVertex& vertex : graph.vertices) index.emplace(vertex.id, index.size());
  DisjointSets parts(graph.vertices.size());
  for (const GraphEdge& edge : graph.edges) {
    if (edge.accepted) parts.Join(index.at(edge.from), index.at(edge.to));
  }
  std::vector<GraphVertex> placed;
  for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
    if (parts.First(i) == 0) placed.push_back(graph.vertices[i]);
  }
  return placed;
}

}  // namespace

void MapMergerConfig::Describe(ConfigVisitor& visitor) {
  for (const char* other : {"input", "points", "odometry", "output", "mapping", "localization",
                            "navigation", "exploration"}) {
    visitor.Foreign(other);
  }
  visitor.Section("loop", loop, "loop closing");
  visitor.Section("map", map, "what is made of the keyframes when a map is saved");
}

void MapMergerConfig::Validate(ConfigProblems& problems) const {
  loop.Validate(problems);
  map.Validate(problems);
}

MergedMap MapMerger::Merge(const std::vector<MapFolder>& maps, const std::string& out,
                           const Progress& progress) const {
  if (maps.size() < 2) throw InputError("two maps or more are needed to join them");
  Verify(maps, progress);
  CheckDistinct(maps);
  MergedMap merged;
  merged.path = out;
  const SavedSession session = Join(maps, progress, merged);
  Save(session, maps.front().manifest(), progress, merged);
  return merged;
}

SavedSession MapMerger::Join(const std::vector<MapFolder>& maps, const Progress& progress,
                             MergedMap& merged) const {
  std::vector<SavedSession> waiting;
  for (const MapFolder& map : maps) waiting.push_back(LoadSession(map));
  SessionJoin join(config_.loop, waiting.front());
  waiting.erase(waiting.begin());
  while (!waiting.empty()) {
    std::string reason;
    const auto joins = [&](const SavedSession& session) {
      const SessionJoinResult result = join.Add(
          session, [&](double share) { Report(progress, "joining " + session.name, share); });
      if (result.joined) merged.sessions.push_back({session.name, result});
      if (reason.empty()) reason = result.reason;
      return result.joined;
    };
    const auto joined = std::find_if(waiting.begin(), waiting.end(), joins);
    if (joined == waiting.end()) {
      throw InputError(waiting.front().name + ": cannot be joined to " + join.session().name +
                       ": " + reason);
    }
    waiting.erase(joined);
  }
  return join.session();
}

void MapMerger::Save(const SavedSession& session, const MapManifest& first,
                     const Progress& progress, MergedMap& merged) const {
  MapWriter writer(merged.path);
  for (const GraphVertex& vertex : session.graph.vertices) {
    writer.AddKeyframe(vertex.id, session.clouds.at(vertex.id));
  }
  writer.AddGraph(session.graph);
  writer.AddDescriptors(Serialize(session.submaps));
  const std::vector<GraphVertex> placed = Placed(session.graph);
  const auto load = [&](std::uint32_t id) { return ReadPointCloud(session.clouds.at(id)); };
  const BuiltMap built =
      MapBuilder(config_.map).Build(placed, load, writer.OccupancyPath(), [&](double share) {
        Report(progress, "building " + merged.path, share);
      });
  writer.AddCloud(built.cloud);
  writer.AddGrid(built.grid);
  writer.Commit(first.configuration, first.frame);
  merged.keyframes = session.graph.vertices.size();
  merged.unplaced = merged.keyframes - placed.size();
  merged.points = built.cloud.size();
}

}  // namespace hv::loop
