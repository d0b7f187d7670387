#include "hv_navigation/mapping_config.h"

namespace hv::navigation {

void SensorModelConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("hit", hit, "probability that a voxel with a return is occupied, 0.5 to 1");
  visitor.Field("miss", miss, "probability that a voxel that a ray passed is occupied, 0 to 0.5");
  visitor.Field("min_range_m", min_range_m, "nearer returns are of the robot itself [m]");
  visitor.Field("mark_range_m", mark_range_m, "returns further away mark nothing [m]");
  visitor.Field("clear_range_m", clear_range_m, "how far rays clear what they pass [m]");
  visitor.Field("far_m", far_m, "distance beyond which only some rays of a scan do so [m]");
  visitor.Field("far_every", far_every, "one of so many, in turns");
}

void SensorModelConfig::Validate(ConfigProblems& problems, const std::string& section) const {
  problems.Require(hit > 0.5 && hit < 1.0, section + ".hit", "must lie between 0.5 and 1");
  problems.Require(miss > 0.0 && miss < 0.5, section + ".miss", "must lie between 0 and 0.5");
  problems.Require(min_range_m >= 0.0, section + ".min_range_m", "must not be negative");
  problems.Require(mark_range_m > min_range_m, section + ".mark_range_m",
                   "must be larger than min_range_m");
  problems.Require(clear_range_m > 0.0, section + ".clear_range_m", "must be positive");
  problems.Require(far_m > 0.0, section + ".far_m", "must be positive");
  problems.Require(far_every >= 1, section + ".far_every", "must be at least 1");
}

void ObstacleMapConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("voxel_m", voxel_m, "edge of a voxel [m]");
  visitor.Field("region_m", region_m,
                "what lies further from the robot, along x or y, is dropped [m]");
  visitor.Field("region_height_m", region_height_m, "the same above and below the robot [m]");
  visitor.Field("least", least, "lowest probability that a voxel is occupied, 0 to 0.5");
  visitor.Field("most", most, "highest probability that a voxel is occupied, 0.5 to 1");
  visitor.Section("lidar", lidar, "returns of the LiDAR");
  visitor.Section("depth", depth, "points of the depth camera");
}

void ObstacleMapConfig::Validate(ConfigProblems& problems) const {
  const auto require = [&](bool condition, const char* key, const char* what) {
    problems.Require(condition, std::string("obstacle_map.") + key, what);
  };
  constexpr double kMostVoxels = 1500.0;
  require(voxel_m >= 0.02 && voxel_m <= 1.0, "voxel_m", "must lie between 0.02 and 1");
  require(region_m >= 10.0 * voxel_m && region_m <= kMostVoxels * voxel_m, "region_m",
          "must be 10 to 1500 voxels");
  require(region_height_m >= 10.0 * voxel_m && region_height_m <= 0.2 * kMostVoxels * voxel_m,
          "region_height_m", "must be 10 to 300 voxels");
  require(least > 0.0 && least < 0.5, "least", "must lie between 0 and 0.5");
  require(most > 0.5 && most < 1.0, "most", "must lie between 0.5 and 1");
  lidar.Validate(problems, "obstacle_map.lidar");
  depth.Validate(problems, "obstacle_map.depth");
}

void DepthConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("required", required, "the robot stands until the first image has come");
  visitor.Field("min_range_m", min_range_m, "nearest depth [m]");
  visitor.Field("max_range_m", max_range_m, "furthest depth [m]");
  visitor.Field("speckle_step_m", speckle_step_m,
                "neighbouring pixels nearer in depth belong together [m]");
  visitor.Field("speckle_pixels", speckle_pixels, "smaller groups of pixels are noise");
  visitor.Field("flying_incidence_deg", flying_incidence_deg,
                "surfaces at less than this to the ray are mixtures of two [deg]");
  visitor.Field("median_pixels", median_pixels, "edge of the median filter: 0 (none), 3 or 5");
  visitor.Field("decimation", decimation, "one point for so many columns and rows");
}

void DepthConfig::Validate(ConfigProblems& problems) const {
  const auto require = [&](bool condition, const char* key, const char* what) {
    problems.Require(condition, std::string("depth_image.") + key, what);
  };
  require(min_range_m > 0.0, "min_range_m", "must be positive");
  require(max_range_m > min_range_m && max_range_m <= 32.0, "max_range_m",
          "must lie between min_range_m and 32");
  require(speckle_step_m > 0.0 && speckle_step_m <= 32.0, "speckle_step_m",
          "must be positive and at most 32");
  require(speckle_pixels >= 0, "speckle_pixels", "must not be negative");
  require(flying_incidence_deg > 0.0 && flying_incidence_deg < 45.0, "flying_incidence_deg",
          "must lie between 0 and 45");
  require(median_pixels == 0 || median_pixels == 3 || median_pixels == 5, "median_pixels",
          "must be 0, 3 or 5");
  require(decimation >= 1, "decimation", "must be at least 1");
}

void GroundConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("base_height_m", base_height_m, "origin of the base above the floor [m]");
  visitor.Field("seed_radius_m", seed_radius_m, "floor under the robot, known by its pose [m]");
  visitor.Field("max_slope_deg", max_slope_deg, "steepest slope that the robot drives on [deg]");
  visitor.Field("max_step_m", max_step_m, "highest step that the robot drives over [m]");
}

void GroundConfig::Validate(ConfigProblems& problems) const {
  problems.Require(seed_radius_m > 0.0, "ground.seed_radius_m", "must be positive");
  problems.Require(max_slope_deg > 0.0 && max_slope_deg < 45.0, "ground.max_slope_deg",
                   "must lie between 0 and 45");
  problems.Require(max_step_m > 0.0, "ground.max_step_m", "must be positive");
}

void ObstacleGridConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("side_m", side_m, "of the square around the robot that is seen as a grid [m]");
  visitor.Field("near_side_m", near_side_m, "of the square that is made anew for every scan [m]");
  visitor.Field("whole_period_s", whole_period_s, "the whole square is made anew as often [s]");
  visitor.Field("robot_height_m", robot_height_m, "height of the robot [m]");
  visitor.Field("height_margin_m", height_margin_m, "kept free above the robot [m]");
}

void ObstacleGridConfig::Validate(ConfigProblems& problems) const {
  problems.Require(near_side_m >= 4.0 && near_side_m <= side_m, "obstacle_grid.near_side_m",
                   "must lie within 4 and obstacle_grid.side_m");
  problems.Require(whole_period_s >= 0.0, "obstacle_grid.whole_period_s", "must not be negative");
  problems.Require(side_m >= 4.0 && side_m <= 200.0, "obstacle_grid.side_m",
                   "must lie between 4 and 200");
  problems.Require(robot_height_m > 0.0, "obstacle_grid.robot_height_m", "must be positive");
  problems.Require(height_margin_m >= 0.0, "obstacle_grid.height_margin_m", "must not be negative");
}

void GlobalGridConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("clear_range_m", clear_range_m,
                "the saved map is corrected where free space is seen from nearer [m]");
  visitor.Field("clear_views", clear_views, "views in a row after which an obstacle is taken away");
  visitor.Field("mark_views", mark_views, "views in a row after which an obstacle is added");
  visitor.Field("movable_m", movable_m, "obstacles of a saved map that are larger stay [m]");
  visitor.Field("resolution_m", resolution_m, "edge of a cell without a saved map [m]");
  visitor.Field("max_side_m", max_side_m, "longest side of the grid [m]");
  visitor.Field("growth_m", growth_m, "by which the grid grows [m]");
  visitor.Field("cross_unknown", cross_unknown,
                "without a saved map, plans lead through unseen places too");
}

void GlobalGridConfig::Validate(ConfigProblems& problems) const {
  const auto require = [&](bool condition, const char* key, const char* what) {
    problems.Require(condition, std::string("global_grid.") + key, what);
  };
  constexpr int kMostViews = 100;
  require(clear_range_m > 0.0, "clear_range_m", "must be positive");
  require(clear_views >= 1 && clear_views <= kMostViews, "clear_views", "must be 1 to 100");
  require(mark_views >= 1 && mark_views <= kMostViews, "mark_views", "must be 1 to 100");
  require(movable_m >= 0.0, "movable_m", "must not be negative");
  require(resolution_m >= 0.01, "resolution_m", "must be at least 0.01");
  require(growth_m >= resolution_m, "growth_m", "must be at least resolution_m");
  require(max_side_m >= growth_m && max_side_m <= 20000.0 * resolution_m, "max_side_m",
          "must be at least growth_m and at most 20000 cells");
}

void MappingConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("obstacle_map", obstacle_map, "the 3-D map of what stands around the robot");
  visitor.Section("depth_image", depth_image, "filters of the depth camera's images");
  visitor.Section("ground", ground, "the ground, and what the robot can drive on");
  visitor.Section("obstacle_grid", obstacle_grid, "the 2-D grids of obstacles");
  visitor.Section("global_grid", global_grid, "the grid in the frame of the map");
  visitor.Section("moving", moving, "people, and whatever else moves");
}

void MappingConfig::Validate(ConfigProblems& problems) const {
  obstacle_map.Validate(problems);
  depth_image.Validate(problems);
  ground.Validate(problems);
  obstacle_grid.Validate(problems);
  global_grid.Validate(problems);
  moving.Validate(problems);
}

}  // namespace hv::navigation
