#pragma once

#include <cstddef>
#include <string>

#include <Eigen/Core>

#include "hv_core/map_folder.h"
#include "hv_replay/json.h"

namespace hv::replay {

/// Figures of a saved map.
struct MapReport {
  std::string path;
  bool plain_cloud = false;  ///< a single point cloud file
  MapContents contents;
  MapManifest manifest;
  std::size_t loops_rejected = 0;
  double path_length_m = 0.0;  ///< along the keyframes
  double duration_s = 0.0;     ///< from the first keyframe to the last
  std::size_t cloud_points = 0;
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();  ///< corner of the cloud [m]
  Eigen::Vector3d upper = Eigen::Vector3d::Zero();  ///< opposite corner [m]
  double grid_resolution_m = 0.0;
  int grid_width = 0;
  int grid_height = 0;
  std::size_t bytes = 0;  ///< of all files
};

/// Reads cloud, graph and grid. Throws InputError.
MapReport ReportMap(const MapFolder& map);

JsonObject MapReportJson(const MapReport& report);

/// Lines for a terminal.
std::string MapReportText(const MapReport& report);

}  // namespace hv::replay
