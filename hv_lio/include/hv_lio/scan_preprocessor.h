#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_core/scan.h"
#include "hv_core/se3.h"
#include "hv_lio/imu_propagation.h"

namespace hv::lio {

struct PreprocessConfig {
  double cell_size_m = 0.5;
  double range_sigma_m = 0.015;
  double bearing_sigma_rad = 2e-4;
  int max_cells = 20000;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// The points of one scan that fell into one cell of a grid in the IMU frame, as a whole: the
/// matcher and the map see the mean with the accuracy of all of them.
struct SurfaceCell {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();     ///< IMU frame at scan end [m]
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();  ///< covariance of the points [m^2]
  /// Expected measurement covariance of one point (range and bearing noise) [m^2].
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
  double count = 0.0;
};

/// Motion during a scan: knots in time order, times relative to the scan stamp; the first knot
/// starts at or before the first point.
struct ScanMotion {
  std::vector<MotionKnot> knots;
  double end_time = 0.0;  ///< of the frame that deskewed points are expressed in [s]

  /// Pose of the IMU at `time` in odom.
  Pose PoseAt(double time) const;
};

/// Moves every point from its own firing time to the scan end (methods section 1, deskew). In:
/// points in the LiDAR frame; out: points in the IMU frame at the scan end. The pose is evaluated
/// exactly every half millisecond and interpolated linearly between. Parallel with TBB, the result
/// does not depend on the number of threads.
std::vector<Point> Deskew(const Scan& scan, const ScanMotion& motion, const Pose& T_imu_lidar);

/// Groups points into cells in order of first appearance. Not finite points are skipped.
class CellGrid {
 public:
  explicit CellGrid(const PreprocessConfig& config);

  std::vector<SurfaceCell> Group(const std::vector<Point>& points,
                                 const Eigen::Vector3d& sensor_origin);

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t index = 0;
    std::uint32_t generation = 0;
  };
  struct Sums {
    float origin[3];
    float count;
    float sum[3];
    float outer[6];
  };
  std::uint32_t FindOrAdd(std::uint64_t key, const Point& point);
  void Grow();
  SurfaceCell Finish(const Sums& sums, const Eigen::Vector3d& sensor_origin) const;

  PreprocessConfig config_;
  std::vector<Slot> table_;
  std::vector<Sums> sums_;
  std::uint32_t generation_ = 0;
};

}  // namespace hv::lio
