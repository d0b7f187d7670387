#include "hv_navigation/surroundings.h"

#include <algorithm>
#include <utility>

#include "hv_navigation/obstacle_grid.h"

namespace hv::navigation {

using Unknown = ClearanceGrid::Unknown;

Surroundings::Surroundings(const MappingConfig& config, double clearance_m,
                           std::optional<OccupancyGrid> saved)
    : config_(config),
      clearance_m_(clearance_m),
      unknown_in_map_(!saved && config.global_grid.cross_unknown ? Unknown::kFree
                                                                 : Unknown::kOccupied),
      obstacles_(config.obstacle_map),
      global_(config.global_grid, std::move(saved)),
      moving_(config.moving) {
  UpdateMap();
}

InsertReport Surroundings::AddScan(Time stamp, const std::vector<Point>& points,
                                   const Pose& T_odom_lidar, const Pose& T_odom_base) {
  obstacles_.MoveTo(T_odom_base.translation());
  const InsertReport report = obstacles_.Insert(Sensor::kLidar, points, T_odom_lidar);
  if (report.refused || report.invalid == report.points) return report;
  scan_stamp_ = stamp;
  scanned_ = true;
  UpdateStamp();
  return report;
}

DepthInsertReport Surroundings::AddDepth(const DepthImage& image, const DepthCameraModel& camera,
                                         const Pose& T_odom_optical, const Pose& T_odom_base) {
  DepthInsertReport report;
  const DepthCloud cloud = ProjectDepth(image, camera, config_.depth_image);
  report.image = cloud.report;
  if (cloud.report.refused) return report;
  obstacles_.MoveTo(T_odom_base.translation());
  report.points = obstacles_.Insert(Sensor::kDepthCamera, cloud.points, T_odom_optical);
  if (report.points.refused) return report;
  depth_stamp_ = image.stamp;
  UpdateStamp();
  return report;
}

void Surroundings::UpdateStamp() {
  if (!scan_stamp_ || (config_.depth_image.required && !depth_stamp_)) return;
  view_.obstacles_stamp = depth_stamp_ ? std::min(*scan_stamp_, *depth_stamp_) : *scan_stamp_;
}

const SurroundingsView& Surroundings::Update(const Pose& T_odom_base,
                                             const std::optional<Pose>& T_map_odom) {
  if (!scanned_ || !T_odom_base.matrix().allFinite()) return view_;
  OccupancyGrid seen = MakeObstacleGrid(obstacles_, config_.ground, config_.obstacle_grid,
                                        T_odom_base, config_.obstacle_grid.side_m);
  if (T_map_odom) {
    global_.Update(seen, Planar(*T_map_odom), T_odom_base.translation().head<2>());
    UpdateMap();
  }
  view_.walkers = std::make_shared<const Walkers>(
      config_.moving.walk, moving_.Track(*scan_stamp_, seen, T_odom_base.translation().head<2>()));
  view_.local =
      std::make_shared<const ClearanceGrid>(std::move(seen), Unknown::kFree, clearance_m_);
  return view_;
}

/// Only what has changed is measured anew.
void Surroundings::UpdateMap() {
  const GlobalGrid::Changes changes = global_.TakeChanges();
  if (changes.everything) {
    view_.map =
        std::make_shared<const ClearanceGrid>(global_.grid(), unknown_in_map_, clearance_m_);
  } else if (changes.cells) {
    view_.map =
        std::make_shared<const ClearanceGrid>(view_.map->WithCells(global_.grid(), *changes.cells));
  }
}

void Surroundings::ForgetObstacles() {
  obstacles_ = ObstacleMap(config_.obstacle_map);
  moving_.Clear();
  scanned_ = false;
}

void Surroundings::ForgetViews() {
  global_.ForgetViews();
  UpdateMap();
}

}  // namespace hv::navigation
