#include "keyframe_queue.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

namespace hv::loop {
namespace {

class KeyframeQueueTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static hv_msgs::KeyframeConstPtr Numbered(std::uint32_t id) {
    auto keyframe = boost::make_shared<hv_msgs::Keyframe>();
    keyframe->id = id;
    keyframe->child_frame_id = "imu";
    keyframe->cloud.data.resize(1000, static_cast<std::uint8_t>(id));
    return keyframe;
  }

  std::size_t Files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_),
                                                  std::filesystem::directory_iterator()));
  }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("hv_keyframe_queue_" + std::to_string(getpid()));
};

TEST_F(KeyframeQueueTest, NothingIsLostBeyondWhatFitsIntoMemory) {
  KeyframeQueue queue(folder_, 3);
  for (std::uint32_t id = 0; id < 10; ++id) queue.Push(Numbered(id));
  EXPECT_EQ(queue.counters().waiting, 10U);
  EXPECT_EQ(queue.counters().on_disk, 7U);
  EXPECT_EQ(Files(), 7U);
  queue.Close();
  for (std::uint32_t id = 0; id < 10; ++id) {
    const auto keyframe = queue.Pop();
    ASSERT_TRUE(keyframe);
    EXPECT_EQ(keyframe->id, id);
    EXPECT_EQ(keyframe->child_frame_id, "imu");
    EXPECT_EQ(keyframe->cloud.data, Numbered(id)->cloud.data);
  }
  EXPECT_FALSE(queue.Pop());
  EXPECT_EQ(Files(), 0U);
}

TEST_F(KeyframeQueueTest, ADiskThatFailsLeavesKeyframesInMemory) {
  KeyframeQueue queue(folder_ / "missing", 1);
  for (std::uint32_t id = 0; id < 3; ++id) queue.Push(Numbered(id));
  EXPECT_EQ(queue.counters().disk_errors, 2U);
  for (std::uint32_t id = 0; id < 3; ++id) EXPECT_EQ(queue.Pop()->id, id);
}

TEST_F(KeyframeQueueTest, ADamagedFileIsCountedAndPassedOver) {
  KeyframeQueue queue(folder_, 1);
  for (std::uint32_t id = 0; id < 3; ++id) queue.Push(Numbered(id));
  std::ofstream(folder_ / "waiting-1.msg", std::ios::trunc) << "short";
  EXPECT_EQ(queue.Pop()->id, 0U);
  EXPECT_EQ(queue.Pop()->id, 2U);
  EXPECT_EQ(queue.counters().lost, 1U);
}

TEST_F(KeyframeQueueTest, LeavesNoFilesBehindAndRemovesThoseOfAnEarlierRun) {
  std::ofstream(folder_ / "waiting-7.msg") << "old";
  {
    KeyframeQueue queue(folder_, 1);
    EXPECT_EQ(Files(), 0U);
    for (std::uint32_t id = 0; id < 4; ++id) queue.Push(Numbered(id));
  }
  EXPECT_EQ(Files(), 0U);
}

}  // namespace
}  // namespace hv::loop
