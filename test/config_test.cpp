#include <filesystem>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "hv_core/config.h"
#include "hv_replay/slam_config.h"

namespace hv::replay {
namespace {

TEST(ShippedConfiguration, EveryFileIsAccepted) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(HV_CONFIG_DIRECTORY)) {
    if (entry.path().extension() != ".yaml") continue;
    ++files;
    SlamConfig config;
    const std::string path = entry.path().string();
    EXPECT_NO_THROW(ReadConfig(LoadYamlFile(path), path, config)) << path;
  }
  EXPECT_GE(files, 6);
}

TEST(ShippedConfiguration, FilesHoldOnlyWhatDiffersFromTheDefaults) {
  const YAML::Node defaults = ParseYaml(ToYaml(SlamConfig{}), "defaults");
  const std::function<void(const YAML::Node&, const YAML::Node&, const std::string&)> compare =
      [&compare](const YAML::Node& node, const YAML::Node& standard, const std::string& where) {
        for (const auto& pair : node) {
          const std::string key = pair.first.as<std::string>();
          const std::string place = where + "." + key;
          if (pair.second.IsMap()) {
            compare(pair.second, standard[key], place);
          } else {
            EXPECT_NE(YAML::Dump(pair.second), YAML::Dump(standard[key])) << place;
          }
        }
      };
  for (const auto& entry : std::filesystem::directory_iterator(HV_CONFIG_DIRECTORY)) {
    if (entry.path().extension() != ".yaml") continue;
    compare(LoadYamlFile(entry.path().string()), defaults, entry.path().filename().string());
  }
}

}  // namespace
}  // namespace hv::replay
