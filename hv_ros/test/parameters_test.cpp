#include "hv_ros/parameters.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "hv_core/error.h"

namespace hv {
namespace {

using XmlRpc::XmlRpcValue;

struct Inner {
  std::vector<double> offsets{0.0, 0.0};

  void Describe(ConfigVisitor& visitor) { visitor.Field("offsets", offsets, ""); }
  void Validate(ConfigProblems&) const {}
};

struct Config {
  std::string topic = "points";
  int threads = 1;
  bool use_imu = true;
  double delay = 0.0;
  Inner inner;

  void Describe(ConfigVisitor& visitor) {
    visitor.Field("topic", topic, "");
    visitor.Field("threads", threads, "");
    visitor.Field("use_imu", use_imu, "");
    visitor.Field("delay", delay, "");
    visitor.Section("inner", inner, "");
    visitor.Foreign("loop");
  }
  void Validate(ConfigProblems&) const {}
};

TEST(Parameters, TreesOfEveryTypeReachTheConfiguration) {
  XmlRpcValue tree;
  tree["topic"] = "/cloud";
  tree["threads"] = 3;
  tree["use_imu"] = false;
  tree["delay"] = 0.0125;
  tree["inner"]["offsets"][0] = 1;
  tree["inner"]["offsets"][1] = 0.1;
  tree["loop"]["anything"] = 7;
  Config config;
  ReadConfig(ToYamlNode(tree), "test", config);
  EXPECT_EQ(config.topic, "/cloud");
  EXPECT_EQ(config.threads, 3);
  EXPECT_FALSE(config.use_imu);
  EXPECT_EQ(config.delay, 0.0125);
  EXPECT_EQ(config.inner.offsets, (std::vector<double>{1.0, 0.1}));
}

TEST(Parameters, UnknownAndMistypedParametersAreNamedTogether) {
  XmlRpcValue tree;
  tree["topics"] = "/cloud";
  tree["threads"] = "many";
  Config config;
  try {
    ReadConfig(ToYamlNode(tree), "parameters of /node", config);
    FAIL() << "no error";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("'topic'"), std::string::npos) << text;
    EXPECT_NE(text.find("threads"), std::string::npos) << text;
    EXPECT_NE(text.find("/node"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace hv
