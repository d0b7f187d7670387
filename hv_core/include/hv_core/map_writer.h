#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hv_core/map_folder.h"

namespace hv {

struct MapWriterOptions {
  /// Swap an existing map with the new one in one step where the file system can. Otherwise the old
  /// map is first renamed to `.<name>.old`, where MapFolder::Open still finds it.
  bool exchange = true;
};

/// Writes a map folder so that, whenever the process or the machine dies, the target is the old map
/// or the new one, whole. Files are collected in a hidden folder beside the target, flushed to disk
/// and put in place by Commit(). What a writer that died left behind is removed by the next one.
/// Not synchronised. Every method throws InputError when the disk is full or writing is not
/// permitted; the old map is then untouched, and the destructor removes what was collected.
class MapWriter {
 public:
  /// Refuses a `path` that is a file, or a folder with content that is not a map.
  explicit MapWriter(const std::string& path, MapWriterOptions options = {});
  ~MapWriter();
  MapWriter(const MapWriter&) = delete;
  MapWriter& operator=(const MapWriter&) = delete;

  /// Takes a keyframe cloud over by a hard link, or a copy on another file system. `pcd_path` must
  /// not be changed afterwards, only removed.
  void AddKeyframe(std::uint32_t id, const std::string& pcd_path);
  /// graph.g2o, and poses.tum made of its vertices.
  void AddGraph(const PoseGraphData& graph);
  void AddDescriptors(std::string_view bytes);
  /// cloud.pcd, points in the map frame.
  void AddCloud(const std::vector<Point>& points);
  /// grid.pgm and grid.yaml; nothing for a grid without cells.
  void AddGrid(const OccupancyGrid& grid);
  /// Where the caller writes occupancy.bt before Commit().
  std::string OccupancyPath() const { return stage_ + "/occupancy.bt"; }

  /// Makes what was added the map at `path`. Files in the old folder that are not part of a map are
  /// kept. To be called once, last. `configuration`: YAML text, saved in the manifest.
  void Commit(const std::string& configuration, const std::string& frame = "map");

 private:
  void CheckTarget() const;
  void RecoverOldMap() const;
  void RemoveStaleStages() const;
  void MakeStage();
  bool LockStage();
  void KeepForeignFiles() const;
  void ListAndSync();
  void Swap();
  void ReplaceInTwoSteps();
  std::string OldMapPath() const;

  const MapWriterOptions options_;
  std::string target_;
  std::string parent_;
  std::string stage_;  ///< empty after Commit()
  int lock_ = -1;      ///< descriptor of the locked stage
  MapManifest manifest_;
};

}  // namespace hv
