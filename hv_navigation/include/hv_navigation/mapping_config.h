#pragma once

#include <string>

#include "hv_core/config.h"
#include "hv_navigation/moving_obstacles.h"

namespace hv::navigation {

/// What a return and a ray that passes say about a voxel, and how far they are believed.
struct SensorModelConfig {
  double hit = 0.7;            ///< probability that a voxel with a return is occupied
  double miss = 0.35;          ///< probability that one that a ray passed is
  double min_range_m = 0.3;    ///< nearer returns are of the robot itself
  double mark_range_m = 15.0;  ///< returns further away mark nothing
  double clear_range_m = 15.0;
  double far_m = 8.0;  ///< beyond that, only some of the rays of a scan clear
  int far_every = 2;   ///< one of so many, in the next scan another one

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems, const std::string& section) const;
};

/// The 3-D map of what stands around the robot.
struct ObstacleMapConfig {
  double voxel_m = 0.1;
  double region_m = 20.0;        ///< what lies further from the robot, along x or y, is dropped
  double region_height_m = 4.0;  ///< the same above and below
  double least = 0.2;            ///< probabilities stay within, so that changes show soon
  double most = 0.9;
  SensorModelConfig lidar;
  SensorModelConfig depth{0.7, 0.4, 0.15, 3.0, 3.0, 3.0, 1};

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Images of the depth camera.
struct DepthConfig {
  bool required = false;            ///< the robot stands until the first image has come
  double min_range_m = 0.25;        ///< along the optical axis
  double max_range_m = 4.0;         ///< along the optical axis
  double speckle_step_m = 0.1;      ///< neighbours nearer in depth belong together
  int speckle_pixels = 40;          ///< smaller groups are noise
  double flying_incidence_deg = 5;  ///< steeper to the ray: a mixture of two surfaces
  int median_pixels = 3;            ///< edge of the filter: 0 (none), 3 or 5
  int decimation = 4;               ///< one point for so many columns and rows

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// The ground around the robot, and what a robot can drive on.
struct GroundConfig {
  double base_height_m = 0.0;  ///< of the origin of the base above the floor
  double seed_radius_m = 0.3;  ///< the floor under the robot, known by its pose
  double max_slope_deg = 15.0;
  double max_step_m = 0.05;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// The 2-D grids of obstacles.
struct ObstacleGridConfig {
  double side_m = 30.0;         ///< of the square around the robot
  double near_side_m = 14.0;    ///< of the square that is made anew for every scan
  double whole_period_s = 0.5;  ///< all of it is made anew as often
  double robot_height_m = 0.8;
  double height_margin_m = 0.1;  ///< kept free above the robot

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// The grid in the frame of the map.
struct GlobalGridConfig {
  double clear_range_m = 4.0;  ///< the saved map is corrected where free space is nearer
  int clear_views = 5;         ///< in a row before an obstacle is taken away
  int mark_views = 2;          ///< in a row before one is added
  double movable_m = 1.5;      ///< obstacles of a saved map that are larger stay
  double resolution_m = 0.1;   ///< without a saved map
  double max_side_m = 2000.0;  ///< the grid does not grow beyond
  double growth_m = 10.0;      ///< by which it grows
  bool cross_unknown = true;   ///< without a saved map, plans lead through unseen places too

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Everything that obstacle mapping can be told.
struct MappingConfig {
  ObstacleMapConfig obstacle_map;
  DepthConfig depth_image;
  GroundConfig ground;
  ObstacleGridConfig obstacle_grid;
  GlobalGridConfig global_grid;
  MovingObstaclesConfig moving;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::navigation
