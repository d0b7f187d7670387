#include "hv_core/config.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "hv_core/point_cloud_decoder.h"

namespace hv {
namespace {

struct InnerConfig {
  double voxel_size_m = 0.5;
  int layers = 3;
  void Describe(ConfigVisitor& visitor) {
    visitor.Field("voxel_size_m", voxel_size_m, "edge of a root voxel [m]");
    visitor.Field("layers", layers, "octree layers | depth");
  }
  void Validate(ConfigProblems& problems) const {
    problems.Require(voxel_size_m > 0.0, "map.voxel_size_m", "must be above 0");
  }
};

struct OuterConfig {
  bool enabled = true;
  std::string topic = "/points";
  std::vector<double> gravity = {0.0, 0.0, -9.81};
  InnerConfig map;
  void Describe(ConfigVisitor& visitor) {
    visitor.Field("enabled", enabled, "switch");
    visitor.Field("topic", topic, "name");
    visitor.Field("gravity", gravity, "vector");
    visitor.Section("map", map, "the map");
  }
  void Validate(ConfigProblems& problems) const {
    problems.Require(gravity.size() == 3, "gravity", "must have 3 numbers");
    map.Validate(problems);
  }
};

OuterConfig Parse(const std::string& text) {
  OuterConfig config;
  ReadConfig(ParseYaml(text, "test.yaml"), "test.yaml", config);
  return config;
}

std::string RefusalOf(const std::string& text) {
  try {
    Parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Config, AbsentKeysKeepDefaults) {
  const OuterConfig config = Parse("map: {layers: 5}\n");
  EXPECT_TRUE(config.enabled);
  EXPECT_EQ(config.topic, "/points");
  EXPECT_EQ(config.map.layers, 5);
  EXPECT_EQ(config.map.voxel_size_m, 0.5);
}

TEST(Config, EmptyDocumentAndEmptySectionAreFine) {
  EXPECT_EQ(RefusalOf(""), "");
  EXPECT_EQ(RefusalOf("map:\n"), "");
}

TEST(Config, FillsEveryType) {
  const OuterConfig config =
      Parse("enabled: false\ntopic: 5\ngravity: [1, 2.5, -3e-1]\nmap: {voxel_size_m: 1}\n");
  EXPECT_FALSE(config.enabled);
  EXPECT_EQ(config.topic, "5");
  EXPECT_EQ(config.gravity, (std::vector<double>{1.0, 2.5, -0.3}));
  EXPECT_EQ(config.map.voxel_size_m, 1.0);
}

TEST(Config, UnknownKeyNamesTheNearest) {
  EXPECT_EQ(RefusalOf("enabled: true\nmap:\n  voxel_siz_m: 1\n"),
            "test.yaml:3: map.voxel_siz_m: unknown key; nearest is 'voxel_size_m'");
}

TEST(Config, KeysAreQuotedOnOneLine) {
  EXPECT_EQ(RefusalOf("map: {\"voxel_size\\nm\": 1}\n"),
            "test.yaml:1: map.voxel_size?m: unknown key; nearest is 'voxel_size_m'");
}

TEST(Config, WrongTypesAreRefusedWithPosition) {
  EXPECT_EQ(RefusalOf("enabled: 1\n"), "test.yaml:1: enabled: must be true or false");
  EXPECT_EQ(RefusalOf("map: {layers: 2.5}\n"), "test.yaml:1: map.layers: must be a whole number");
  EXPECT_EQ(RefusalOf("map: {layers: 99999999999}\n"),
            "test.yaml:1: map.layers: must be a whole number");
  EXPECT_EQ(RefusalOf("map: {voxel_size_m: '1'}\n"),
            "test.yaml:1: map.voxel_size_m: must be a finite number");
  EXPECT_EQ(RefusalOf("map: {voxel_size_m: .inf}\n"),
            "test.yaml:1: map.voxel_size_m: must be a finite number");
  EXPECT_EQ(RefusalOf("map:\n  voxel_size_m:\n"),
            "test.yaml:2: map.voxel_size_m: must be a finite number");
  EXPECT_EQ(RefusalOf("gravity: 9.81\n"), "test.yaml:1: gravity: must be a list of finite numbers");
  EXPECT_EQ(RefusalOf("gravity: [0, 0, down]\n"),
            "test.yaml:1: gravity: must be a list of finite numbers");
  EXPECT_EQ(RefusalOf("topic: [a]\n"), "test.yaml:1: topic: must be a text");
  EXPECT_EQ(RefusalOf("map: 3\n"), "test.yaml:1: map: must be a mapping of keys to values");
  EXPECT_EQ(RefusalOf("- 1\n"), "test.yaml:1: must be a mapping of keys to values");
}

TEST(Config, KeyGivenTwiceIsRefused) {
  EXPECT_EQ(RefusalOf("topic: a\ntopic: b\n"), "test.yaml:2: topic: given twice");
}

TEST(Config, ReportsEveryProblemAtOnce) {
  EXPECT_EQ(RefusalOf("enable: true\ntopic: {}\ngravity: [1]\nmap: {voxel_size_m: -1, layer: 1}\n"),
            "test.yaml:2: topic: must be a text\n"
            "test.yaml:4: map.layer: unknown key; nearest is 'layers'\n"
            "test.yaml:1: enable: unknown key; nearest is 'enabled'\n"
            "test.yaml: gravity: must have 3 numbers\n"
            "test.yaml: map.voxel_size_m: must be above 0");
}

TEST(Config, SyntaxErrorHasPosition) {
  const std::string error = RefusalOf("map: {layers: 1\nx");
  EXPECT_EQ(error.rfind("test.yaml:", 0), 0U) << error;
  EXPECT_NE(error.find("not valid YAML"), std::string::npos) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

TEST(Config, MissingFileIsNamed) {
  try {
    LoadYamlFile("/nonexistent/a.yaml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "/nonexistent/a.yaml: cannot be opened");
  }
}

TEST(Config, YamlReadsBackIdentically) {
  OuterConfig config;
  config.enabled = false;
  config.topic = "a: b # \"c\"";
  config.gravity = {0.1, -1e-300, 1.0 / 3.0};
  config.map.layers = -7;
  const OuterConfig back = Parse(ToYaml(config));
  EXPECT_EQ(back.enabled, config.enabled);
  EXPECT_EQ(back.topic, config.topic);
  EXPECT_EQ(back.gravity, config.gravity);
  EXPECT_EQ(back.map.layers, config.map.layers);
  for (const std::string text : {"", "null", "~", "true", "1.5", "- x", "caf\xc3\xa9"}) {
    config.topic = text;
    EXPECT_EQ(Parse(ToYaml(config)).topic, text);
  }
}

TEST(Config, TableListsKeysWithDefaults) {
  EXPECT_EQ(ParameterTable<OuterConfig>(),
            "| key | default | meaning |\n|---|---|---|\n"
            "| `enabled` | `true` | switch |\n"
            "| `topic` | `/points` | name |\n"
            "| `gravity` | `[0, 0, -9.81]` | vector |\n"
            "| **map** | | the map |\n"
            "| `map.voxel_size_m` | `0.5` | edge of a root voxel [m] |\n"
            "| `map.layers` | `3` | octree layers \\| depth |\n");
}

TEST(Config, FileIsReadLikeText) {
  const std::string path = testing::TempDir() + "/hv_config_test.yaml";
  std::ofstream(path) << "map: {layers: 9}\n";
  OuterConfig config;
  ReadConfig(LoadYamlFile(path), path, config);
  std::remove(path.c_str());
  EXPECT_EQ(config.map.layers, 9);
}

TEST(Config, DecoderDefaultsAreValid) {
  ConfigProblems problems;
  PointCloudDecoderConfig().Validate(problems);
  EXPECT_TRUE(problems.lines().empty());
}

struct WithForeign {
  int own = 1;
  void Describe(ConfigVisitor& visitor) {
    visitor.Field("own", own, "");
    visitor.Foreign("other");
  }
  void Validate(ConfigProblems&) const {}
};

TEST(ConfigTest, SectionsOfOtherProgramsAreLeftAlone) {
  WithForeign config;
  ReadConfig(ParseYaml("own: 2\nother: {anything: [1, 2]}", "test"), "test", config);
  EXPECT_EQ(config.own, 2);
  EXPECT_EQ(ToYaml(config).find("other"), std::string::npos);
  EXPECT_THROW(ReadConfig(ParseYaml("othr: {}", "test"), "test", config), InputError);
}

}  // namespace
}  // namespace hv
