#include "hv_navigation/mapping_config.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "small_map.h"

namespace hv::navigation {
namespace {

std::string ErrorOfYaml(const std::string& text) {
  MappingConfig config;
  return ErrorOf([&] { ReadConfig(ParseYaml(text, "test"), "test", config); });
}

TEST(MappingConfigTest, DefaultsAreValidAndSurviveWriting) {
  MappingConfig config;
  config.obstacle_map.voxel_m = 0.05;
  MappingConfig read;
  ReadConfig(ParseYaml(ToYaml(config), "test"), "test", read);
  EXPECT_EQ(ToYaml(read), ToYaml(config));
}

TEST(MappingConfigTest, ReportsAllThatIsWrong) {
  const std::string error = ErrorOfYaml(
      "obstacle_map: {voxel_m: 0.0, lidar: {miss: 0.7}}\n"
      "depth_image: {median_pixels: 4, decimation: 0}\n"
      "ground: {max_slope_deg: 90.0}\n"
      "obstacle_grid: {robot_height_m: -1.0}\n"
      "global_grid: {clear_views: 0}\n");
  for (const char* key :
       {"obstacle_map.voxel_m", "obstacle_map.lidar.miss", "depth_image.median_pixels",
        "depth_image.decimation", "ground.max_slope_deg", "obstacle_grid.robot_height_m",
        "global_grid.clear_views"}) {
    EXPECT_NE(error.find(key), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace hv::navigation
