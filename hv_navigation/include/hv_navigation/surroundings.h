#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "hv_core/depth_image.h"
#include "hv_core/occupancy_grid.h"
#include "hv_core/scan.h"
#include "hv_core/se3.h"
#include "hv_core/time.h"
#include "hv_navigation/clearance_grid.h"
#include "hv_navigation/depth_projection.h"
#include "hv_navigation/global_grid.h"
#include "hv_navigation/mapping_config.h"
#include "hv_navigation/moving_obstacles.h"
#include "hv_navigation/obstacle_map.h"

namespace hv::navigation {

/// What planning needs to know about obstacles, as NavigationInput wants it.
struct SurroundingsView {
  std::shared_ptr<const ClearanceGrid> local;     ///< frame of odometry; null before the first scan
  std::shared_ptr<const ClearanceGrid> standing;  ///< the same without those who walk
  std::shared_ptr<const Walkers> walkers;         ///< they, in the same frame
  std::shared_ptr<const ClearanceGrid> map;       ///< frame of the map; null while nothing is known
  bool map_has_additions = false;  ///< it holds obstacles that the saved map does not
  Time obstacles_stamp;            ///< of the oldest among the newest data of the sensors
};

struct DepthInsertReport {
  DepthReport image;
  InsertReport points;
};

/// Makes the grids that robots are driven by from what the obstacle sensors see: the obstacle map,
/// the local grid cut from it, and the grid of the map, in which nobody who walks leaves a trace.
/// The same calls give the same grids.
///
/// The LiDAR is always needed. The depth camera is from its first image on, or from the start where
/// DepthConfig::required says so: from then on data of both must be new. A scan without valid
/// points, and what is refused, are no data.
///
/// Grids that were given out never change. Not thread-safe.
class Surroundings {
 public:
  /// `clearance_m`: up to which distances to obstacles are told, see
  /// PlanningConfig::NeededClearance(). `saved`: the grid of a prior map.
  Surroundings(const MappingConfig& config, double clearance_m,
               std::optional<OccupancyGrid> saved = std::nullopt);

  /// Takes a scan, free of distortion, in the frame of the LiDAR at `stamp`, and the robot then.
  InsertReport AddScan(Time stamp, const std::vector<Point>& points, const Pose& T_odom_lidar,
                       const Pose& T_odom_base);

  /// Takes a depth image, with the poses at its stamp; optical frame: z along the view.
  DepthInsertReport AddDepth(const DepthImage& image, const DepthCameraModel& camera,
                             const Pose& T_odom_optical, const Pose& T_odom_base);

  /// Makes the grids anew, far from the robot not every time; to be called once a scan, since the
  /// grid of the map counts views.
  /// Without a place in the map that grid stays as it is, and after ForgetObstacles() or
  /// LookAgain() both stay until the next scan.
  const SurroundingsView& Update(const Pose& T_odom_base, const std::optional<Pose>& T_map_odom);

  /// The grids of the last update.
  const SurroundingsView& view() const { return view_; }

  /// Forgets what stands around the robot, as when odometry began anew.
  void ForgetObstacles();
  /// Forgets what may not be there and will be seen again if it is: all but what is so near that
  /// the sensors look over it or past it.
  void LookAgain();
  /// Forgets what was seen of the map, for when the place in it was wrong.
  void ForgetViews();
  /// Forgets obstacles in the map that the saved map does not hold; those that are still there will
  /// be seen again.
  void ForgetAdditions();

  const ObstacleMap& obstacle_map() const { return obstacles_; }
  std::size_t cells_left_out() const { return global_.left_out(); }

 private:
  double SideNow();
  /// Makes no grids until the next scan.
  void AwaitScan();
  void UpdateStamp();
  void UpdateMap();

  MappingConfig config_;
  double clearance_m_;
  ClearanceGrid::Unknown unknown_in_map_;
  ObstacleMap obstacles_;
  GlobalGrid global_;
  MovingObstacles moving_;
  Eigen::Vector3d robot_ = Eigen::Vector3d::Zero();  ///< at the last scan, in odometry [m]
  std::optional<Time> scan_stamp_;
  std::optional<Time> depth_stamp_;
  std::optional<Time> whole_stamp_;  ///< when grids last reached as far as they can
  bool scanned_ = false;             ///< since obstacles were forgotten
  SurroundingsView view_;
};

}  // namespace hv::navigation
