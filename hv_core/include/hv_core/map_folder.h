#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hv_core/occupancy_grid.h"
#include "hv_core/point_cloud_file.h"
#include "hv_core/pose_graph_file.h"
#include "hv_core/trajectory.h"

namespace hv {

/// Version of the map folder that is written. Older ones are migrated when they are opened, newer
/// ones refused.
inline constexpr int kMapFormatVersion = 1;

/// One file of a map folder.
struct MapFile {
  std::string name;  ///< relative to the folder, e.g. "keyframes/000012.pcd"
  std::size_t size = 0;
  std::string sha256;  ///< as sha256sum prints it
};

/// What manifest.yaml says. It ends with a sum of its own text, so that damage to it shows as well.
struct MapManifest {
  int format_version = kMapFormatVersion;
  std::string frame = "map";  ///< frame of cloud, poses, grid and occupancy
  std::size_t keyframes = 0;
  std::size_t loops = 0;         ///< accepted loop edges of the graph
  std::size_t cloud_points = 0;  ///< points of cloud.pcd
  std::string configuration;     ///< effective configuration that made the map, YAML text
  std::vector<MapFile> files;    ///< all files but the manifest, sorted by name
};

/// Which parts of a map there are.
struct MapContents {
  bool cloud = false;        ///< cloud.pcd: points in the map frame
  bool keyframes = false;    ///< keyframes/NNNNNN.pcd: points in the frame of the IMU
  bool graph = false;        ///< graph.g2o and poses.tum
  bool descriptors = false;  ///< descriptors.bin
  bool grid = false;         ///< grid.pgm and grid.yaml
  bool occupancy = false;    ///< occupancy.bt
};

/// A saved map, read only. Opens a map folder, or a plain PCD or PLY file as a map that has a cloud
/// and nothing else. Every Read checks size and sum of its file before it believes its content, and
/// throws InputError naming file and fault; asking for a part that is not there does so as well.
/// Const methods are thread-safe.
class MapFolder {
 public:
  /// Checks version, manifest and the presence and size of every file; Verify() checks the rest.
  static MapFolder Open(const std::string& path);

  const std::string& path() const { return path_; }
  bool is_plain_cloud() const { return is_plain_cloud_; }
  const MapManifest& manifest() const { return manifest_; }
  MapContents contents() const;
  /// Ids of the keyframe clouds, ascending.
  std::vector<std::uint32_t> KeyframeIds() const;

  PointCloud ReadCloud() const;
  PointCloud ReadKeyframe(std::uint32_t id) const;
  PoseGraphData ReadGraph() const;
  Trajectory ReadPoses() const;
  std::string ReadDescriptors() const;
  OccupancyGrid ReadGrid() const;
  /// Path of occupancy.bt, whose sum has been checked.
  std::string OccupancyPath() const;

  /// Reads every file, compares all sums and decodes what can be decoded. `progress` is called
  /// with the share done, in [0, 1]. Throws InputError naming the first fault.
  void Verify(const std::function<void(double)>& progress = {}) const;

 private:
  MapFolder() = default;
  bool Has(const std::string& name) const;
  const MapFile& Find(const std::string& name) const;
  std::string ReadChecked(const std::string& name) const;
  void CheckPresence() const;
  void VerifyFile(const MapFile& file) const;
  void CheckCounts() const;

  std::string path_;
  bool is_plain_cloud_ = false;
  MapManifest manifest_;
};

/// "keyframes/000012.pcd".
std::string KeyframeFileName(std::uint32_t id);

}  // namespace hv
