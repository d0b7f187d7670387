#include "hv_navigation/surroundings.h"

#include <algorithm>
#include <utility>

#include "hv_navigation/obstacle_grid.h"

namespace hv::navigation {

using Unknown = ClearanceGrid::Unknown;

namespace {

constexpr double kAround_m = 0.2;  // of a person, for swinging arms and the size of cells

/// Leaves out points on those who walk. The LiDAR sees them, and sees when they are gone; of their
/// feet it would not.
void LeaveOut(const Walkers& walkers, Time now, const Pose& T_odom_optical,
              std::vector<Point>& points) {
  const double person_m = walkers.config().radius_m + kAround_m;
  const auto on_walker = [&](const Point& point) {
    const Eigen::Vector3d at =
        T_odom_optical * Eigen::Vector3f(point.x, point.y, point.z).cast<double>();
    return walkers.MayBeNear(at.head<2>(), person_m, now);
  };
  points.erase(std::remove_if(points.begin(), points.end(), on_walker), points.end());
}

/// Makes unknown what is where one who walks may be; `changed` includes those cells.
void TakeOut(const WalkConfig& config, const Walker& walker, Time now, OccupancyGrid& grid,
             std::optional<CellBox>& changed) {
  const double person_m = config.radius_m + kAround_m;
  const double walked_m = config.most_mps * std::max(0.0, now - walker.stamp);
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(person_m + walked_m);
  const Eigen::Vector2i low = grid.CellOf(walker.place - reach);
  const Eigen::Vector2i high = grid.CellOf(walker.place + reach);
  for (int y = low.y(); y <= high.y(); ++y) {
    for (int x = low.x(); x <= high.x(); ++x) {
      const Eigen::Vector2i at(x, y);
      if (!grid.Contains(at) || !OccupancyGrid::IsOccupied(grid.At(x, y))) continue;
      if (!Walkers::MayBeNear(config, walker, grid.CenterOf(at), person_m, now)) continue;
      grid.At(x, y) = OccupancyGrid::kUnknown;
      Include(at, changed);
    }
  }
}

std::optional<CellBox> TakeOut(const Walkers& walkers, Time now, OccupancyGrid& grid) {
  std::optional<CellBox> changed;
  for (const Walker& walker : walkers.all()) {
    TakeOut(walkers.config(), walker, now, grid, changed);
  }
  return changed;
}

}  // namespace

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
  robot_ = T_odom_base.translation();
  scanned_ = true;
  UpdateStamp();
  return report;
}

DepthInsertReport Surroundings::AddDepth(const DepthImage& image, const DepthCameraModel& camera,
                                         const Pose& T_odom_optical, const Pose& T_odom_base) {
  DepthInsertReport report;
  DepthCloud cloud = ProjectDepth(image, camera, config_.depth_image);
  report.image = cloud.report;
  if (cloud.report.refused) return report;
  if (view_.walkers) LeaveOut(*view_.walkers, image.stamp, T_odom_optical, cloud.points);
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

/// What is far away changes little from scan to scan, and is most of the work.
double Surroundings::SideNow() {
  constexpr double kJitter_s = 0.02;
  const bool whole =
      !whole_stamp_ || *scan_stamp_ < *whole_stamp_ ||
      *scan_stamp_ - *whole_stamp_ > config_.obstacle_grid.whole_period_s - kJitter_s;
  if (!whole) return config_.obstacle_grid.near_side_m;
  whole_stamp_ = scan_stamp_;
  return config_.obstacle_grid.side_m;
}

const SurroundingsView& Surroundings::Update(const Pose& T_odom_base,
                                             const std::optional<Pose>& T_map_odom) {
  if (!scanned_ || !T_odom_base.matrix().allFinite()) return view_;
  OccupancyGrid seen =
      MakeObstacleGrid(obstacles_, config_.ground, config_.obstacle_grid, T_odom_base, SideNow());
  const Eigen::Vector2d robot = T_odom_base.translation().head<2>();
  const std::vector<Walker>& walkers = moving_.Track(*scan_stamp_, seen, robot);
  view_.walkers = std::make_shared<const Walkers>(config_.moving.walk, walkers, moving_.appeared());
  OccupancyGrid standing = seen;
  const std::optional<CellBox> walked = TakeOut(*view_.walkers, *scan_stamp_, standing);
  if (T_map_odom) {
    global_.Update(standing, Planar(*T_map_odom), robot);
    UpdateMap();
  }
  view_.local =
      std::make_shared<const ClearanceGrid>(std::move(seen), Unknown::kFree, clearance_m_);
  view_.standing = view_.local;
  if (walked) {
    view_.standing =
        std::make_shared<const ClearanceGrid>(view_.local->WithCells(std::move(standing), *walked));
  }
  return view_;
}

/// Only what has changed is measured anew.
void Surroundings::UpdateMap() {
  view_.map_has_additions = global_.has_additions();
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
  AwaitScan();
}

void Surroundings::LookAgain() {
  constexpr double kBlind_m = 0.8;
  obstacles_.KeepNear(robot_, kBlind_m);
  AwaitScan();
}

void Surroundings::AwaitScan() {
  moving_.Clear();
  scanned_ = false;
  whole_stamp_.reset();
}

void Surroundings::ForgetViews() {
  global_.ForgetViews();
  UpdateMap();
}

void Surroundings::ForgetAdditions() {
  global_.ForgetAdditions();
  UpdateMap();
}

}  // namespace hv::navigation
