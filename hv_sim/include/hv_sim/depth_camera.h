#pragma once

#include <cstdint>
#include <vector>

#include "hv_core/config.h"
#include "hv_core/depth_image.h"
#include "hv_core/se3.h"
#include "hv_sim/pedestrian.h"
#include "hv_sim/ray_caster.h"

namespace hv::sim {

/// A stereo depth camera in the manner of the RealSense D435. The default resolution is a quarter
/// of the real one, for speed.
struct DepthCameraConfig {
  int width = 212;
  int height = 120;
  double horizontal_fov_deg = 87.0;
  double vertical_fov_deg = 58.0;
  double rate_hz = 15.0;
  double min_depth_m = 0.28;
  double max_depth_m = 10.0;
  double depth_noise = 0.005;  ///< sigma / depth^2 [1/m]; 2 % of the depth at 4 m
  double edge_loss = 0.5;      ///< probability that a pixel at a jump of depth is lost
  bool noise = true;           ///< false: neither noise nor lost pixels
  /// Pose in the base frame, x along the view, z up: x y z [m] qx qy qz qw.
  std::vector<double> T_base_camera = {0.25, 0.0, 0.45, 0.0, 0.1521234, 0.0, 0.9883615};

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;

  double fx() const;                               ///< focal length [px]
  double fy() const;                               ///< focal length [px]
  double cx() const { return 0.5 * (width - 1); }  ///< principal point [px]
  double cy() const { return 0.5 * (height - 1); }
  Pose mounting() const;  ///< T_base_camera as a transform
};

/// From the optical frame (x right, y down, z along the view) to that of the camera.
Pose OpticalInCamera();

/// Casts a ray for each pixel, all at the same instant. Depth comes in steps of 1 mm; pixels nearer
/// or further than the limits are 0, and with noise those on surfaces seen edge-on and many at
/// jumps of depth. Const methods are thread-safe; the result depends on arguments and seed only.
class DepthCamera {
 public:
  /// Throws InputError when the configuration is not valid.
  DepthCamera(DepthCameraConfig config, std::uint32_t seed);

  /// What it sees from `T_world_camera` at `time_s`, which becomes the stamp.
  DepthImage Capture(const RayCaster& scene, const std::vector<PersonPath>& people,
                     const Pose& T_world_camera, double time_s) const;

  const DepthCameraConfig& config() const { return config_; }

 private:
  std::vector<Hit> CastRow(const RayCaster& scene, const std::vector<Pedestrian>& people,
                           const Pose& T_world_optical, int row) const;
  double LossAt(const std::vector<Hit>& hits, int column, int row) const;

  DepthCameraConfig config_;
  std::uint32_t seed_;
  std::vector<Eigen::Vector3d> directions_;  ///< of the pixels, unit length, optical frame
};

}  // namespace hv::sim
