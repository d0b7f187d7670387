#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "hv_explore_sac/train/train_config.h"
#include "hv_replay/slam_config.h"

namespace hv::replay {
namespace {

std::vector<std::string> FilesIn(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(HV_CONFIG_DIRECTORY) + folder)) {
    if (entry.path().extension() == ".yaml") paths.push_back(entry.path().string());
  }
  return paths;
}

template <typename Config>
void ExpectToLoad(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    Config config;
    EXPECT_NO_THROW(ReadConfig(LoadYamlFile(path), path, config)) << path;
  }
}

/// Every value of `node` is another one in `standard`.
void ExpectToDiffer(const YAML::Node& node, const YAML::Node& standard, const std::string& where) {
  for (const auto& pair : node) {
    const std::string key = pair.first.as<std::string>();
    const std::string place = where + "." + key;
    if (pair.second.IsMap()) {
      ExpectToDiffer(pair.second, standard[key], place);
    } else {
      EXPECT_NE(YAML::Dump(pair.second), YAML::Dump(standard[key])) << place;
    }
  }
}

TEST(ShippedConfiguration, EveryFileIsAccepted) {
  EXPECT_GE(FilesIn("").size(), 6U);
  ExpectToLoad<SlamConfig>(FilesIn(""));
  EXPECT_GE(FilesIn("/training").size(), 1U);
  ExpectToLoad<explore::TrainConfig>(FilesIn("/training"));
}

TEST(ShippedConfiguration, FilesHoldOnlyWhatDiffersFromTheDefaults) {
  const YAML::Node slam = ParseYaml(ToYaml(SlamConfig{}), "defaults");
  for (const std::string& path : FilesIn("")) ExpectToDiffer(LoadYamlFile(path), slam, path);
  const YAML::Node training = ParseYaml(ToYaml(explore::TrainConfig{}), "defaults");
  for (const std::string& path : FilesIn("/training")) {
    ExpectToDiffer(LoadYamlFile(path), training, path);
  }
}

}  // namespace
}  // namespace hv::replay
