#include "hv_loop_btc/saved_session.h"

#include <gtest/gtest.h>

#include "hv_core/config.h"
#include "hv_loop_btc/mapping_config.h"

namespace hv::loop {
namespace {

MapManifest With(const std::string& configuration) {
  MapManifest manifest;
  manifest.configuration = configuration;
  return manifest;
}

TEST(DescriptorConfigTest, IsThatOfTheMap) {
  MappingConfig config;
  config.loop.btc.max_keypoints = 37;
  config.loop.btc.scale = "outdoor";
  const auto read = DescriptorConfigOf(With(ToYaml(config)));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->max_keypoints, 37);
  EXPECT_EQ(read->scale, "outdoor");
  EXPECT_EQ(read->max_triangles, BtcConfig().max_triangles);
}

TEST(DescriptorConfigTest, IsNothingWhereTheManifestDoesNotTell) {
  for (const char* text : {"", "loop: 3", "loop: {submap: {}}", "- 1", "loop: {btc: {side: 1}}",
                           "loop: {btc: {max_keypoints: many}}", "loop: [", "other: {}"}) {
    EXPECT_FALSE(DescriptorConfigOf(With(text))) << text;
  }
}

}  // namespace
}  // namespace hv::loop
