#include "sensor_queue.h"

#include <thread>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

namespace hv::navigation {
namespace {

hv_msgs::TrackedScanPtr ScanOf(std::uint32_t segment) {
  auto scan = boost::make_shared<hv_msgs::TrackedScan>();
  scan->segment = segment;
  return scan;
}

const auto kCamera = boost::make_shared<sensor_msgs::CameraInfo>();

TEST(SensorQueue, NewerOnesTakeThePlaceOfWhatWaits) {
  SensorQueue queue;
  queue.Push(boost::make_shared<sensor_msgs::Image>(), kCamera);
  for (std::uint32_t segment = 1; segment <= 3; ++segment) queue.Push(ScanOf(segment));
  const auto input = queue.Pop();
  ASSERT_TRUE(input);
  ASSERT_TRUE(input->scan);
  EXPECT_EQ(input->scan->segment, 3U);
  EXPECT_TRUE(input->image) << "sensors do not push each other out";
  EXPECT_EQ(queue.counters().scans_dropped, 2U);
  EXPECT_EQ(queue.counters().images_dropped, 0U);
}

TEST(SensorQueue, WhatWasTakenIsGone) {
  SensorQueue queue;
  queue.Push(ScanOf(1));
  queue.Pop();
  queue.Push(boost::make_shared<sensor_msgs::Image>(), kCamera);
  const auto input = queue.Pop();
  ASSERT_TRUE(input);
  EXPECT_FALSE(input->scan);
  EXPECT_TRUE(input->image);
  EXPECT_EQ(input->camera, kCamera);
}

TEST(SensorQueue, ClosingWakesWhoWaits) {
  SensorQueue queue;
  std::thread closer([&] { queue.Close(); });
  EXPECT_FALSE(queue.Pop());
  closer.join();
  queue.Push(ScanOf(1));
  EXPECT_FALSE(queue.Pop());
}

}  // namespace
}  // namespace hv::navigation
