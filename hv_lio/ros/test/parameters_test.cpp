#include "parameters.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "hv_core/error.h"

namespace hv::lio {
namespace {

using XmlRpc::XmlRpcValue;

TEST(Parameters, TreesOfEveryTypeReachTheConfiguration) {
  XmlRpcValue tree;
  tree["input"]["points_topic"] = "/cloud";
  tree["odometry"]["threads"] = 3;
  tree["odometry"]["use_imu"] = false;
  tree["odometry"]["lidar_time_offset_s"] = 0.0125;
  tree["odometry"]["extrinsic"]["translation_m"][0] = 1;
  tree["odometry"]["extrinsic"]["translation_m"][1] = 0.1;
  tree["odometry"]["extrinsic"]["translation_m"][2] = -2.0;
  SystemConfig config;
  ReadConfig(ToYamlNode(tree), "test", config);
  EXPECT_EQ(config.input.points_topic, "/cloud");
  EXPECT_EQ(config.odometry.threads, 3);
  EXPECT_FALSE(config.odometry.use_imu);
  EXPECT_EQ(config.odometry.lidar_time_offset_s, 0.0125);
  EXPECT_EQ(config.odometry.extrinsic.translation_m, (std::vector<double>{1.0, 0.1, -2.0}));
}

TEST(Parameters, UnknownAndMistypedParametersAreNamedTogether) {
  XmlRpcValue tree;
  tree["input"]["point_topic"] = "/cloud";
  tree["odometry"]["threads"] = "many";
  SystemConfig config;
  try {
    ReadConfig(ToYamlNode(tree), "parameters of /hv_lio", config);
    FAIL() << "no error";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("points_topic"), std::string::npos) << text;
    EXPECT_NE(text.find("threads"), std::string::npos) << text;
    EXPECT_NE(text.find("/hv_lio"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace hv::lio
