#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hv_core/scan.h"
#include "hv_core/se3.h"
#include "hv_sim/ray_caster.h"
#include "hv_sim/world.h"

namespace hv::sim {

/// Geometry and timing of a spinning LiDAR whose frame has z up along the spin axis. A channel is a
/// laser in firing order, and becomes Point::ring.
struct LidarModel {
  std::string name;
  std::vector<double> elevation;       ///< per channel [rad]
  std::vector<double> azimuth_offset;  ///< per channel, along the spin, within a column [rad]
  std::vector<double> firing_delay;    ///< per channel within its column [s]
  int columns = 2000;                  ///< per revolution
  double column_period = 50e-6;        ///< [s]
  double range_sigma = 0.01;           ///< [m]
  double min_range = 0.05;             ///< [m]
  double max_range = 120.0;            ///< of the receiver's clock [m]
  double range_at_10_percent = 80.0;   ///< limit on a matt target of reflectivity 0.1 [m]
  double beam_divergence = 3e-3;       ///< full angle [rad]
  bool clockwise = true;               ///< seen from above
  double start_azimuth = 0.0;          ///< of column 0, from x towards y [rad]

  double period() const { return columns * column_period; }

  /// Unit direction in the LiDAR frame of one firing.
  Eigen::Vector3d Direction(int column, std::size_t channel) const;
};

/// Hesai PandarXT-32 at 10 Hz: rings count from the top, 0 degrees is y, as its driver gives it.
LidarModel PandarXt32();

/// Velodyne HDL-32E at 10 Hz: rings are the numbers of the lasers in firing order.
LidarModel Hdl32e();

struct LidarOptions {
  bool noise = true;          ///< range noise, mixed pixels and random loss of weak returns
  bool people = true;         ///< moving people are seen
  double dropout = 0.0;       ///< probability that a return is lost
  double azimuth_keep = 1.0;  ///< share of columns fired, for speed; 1 fires all
};

/// Casts every ray from the exact pose of its own firing time. Const methods are thread-safe; the
/// result depends only on arguments and seed, not on the number of threads.
class LidarSimulator {
 public:
  LidarSimulator(const World& world, LidarModel model, LidarOptions options, std::uint32_t seed);
  /// The same with triangles that others use too.
  LidarSimulator(std::shared_ptr<const RayCaster> scene, std::vector<PersonPath> people,
                 LidarModel model, LidarOptions options, std::uint32_t seed);
  ~LidarSimulator();

  /// Other static surroundings from now on. Not while a const method runs.
  void SetScene(std::shared_ptr<const RayCaster> scene);

  /// One revolution whose first firing is at `start_s` [s]; points in firing order, times from
  /// `start_s`. `T_world_lidar(t)` is the LiDAR pose at time t [s]; it is called from several
  /// threads, up to one column past the end of the revolution. Scan::stamp is
  /// Time::FromSeconds(start_s).
  Scan Sweep(double start_s, const std::function<Pose(double)>& T_world_lidar) const;

  /// Distance from `point` to the nearest static surface, at most `limit` [m].
  double DistanceToSurface(const Eigen::Vector3d& point, double limit) const;

  const LidarModel& model() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hv::sim
