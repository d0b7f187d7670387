#include "input_queue.h"

#include <boost/make_shared.hpp>
#include <gtest/gtest.h>

namespace hv::lio {
namespace {

sensor_msgs::PointCloud2ConstPtr Cloud(std::uint32_t width) {
  auto cloud = boost::make_shared<sensor_msgs::PointCloud2>();
  cloud->width = width;
  return cloud;
}

ImuSample Sample(double t) {
  ImuSample sample;
  sample.stamp = Time::FromSeconds(t);
  return sample;
}

TEST(InputQueue, KeepsTheOrderOfArrival) {
  InputQueue queue(5, 5);
  queue.Push(Sample(1.0));
  queue.Push(Cloud(7));
  queue.Push(Sample(2.0));
  EXPECT_EQ(queue.Pop()->imu.stamp, Time::FromSeconds(1.0));
  EXPECT_EQ(queue.Pop()->cloud->width, 7U);
  EXPECT_EQ(queue.Pop()->imu.stamp, Time::FromSeconds(2.0));
}

TEST(InputQueue, DropsTheOldestOfTheKindThatOverflows) {
  InputQueue queue(2, 3);
  queue.Push(Sample(1.0));
  for (std::uint32_t i = 0; i < 4; ++i) queue.Push(Cloud(i));
  EXPECT_EQ(queue.counters().scans_dropped, 2U);
  EXPECT_EQ(queue.counters().imu_dropped, 0U);
  for (int i = 2; i <= 4; ++i) queue.Push(Sample(i));
  EXPECT_EQ(queue.counters().imu_dropped, 1U);
  EXPECT_EQ(queue.Pop()->cloud->width, 2U);
  EXPECT_EQ(queue.Pop()->cloud->width, 3U);
  EXPECT_EQ(queue.Pop()->imu.stamp, Time::FromSeconds(2.0));
}

TEST(InputQueue, GivesOutWhatWaitsAfterClosing) {
  InputQueue queue(2, 2);
  queue.Push(Sample(1.0));
  queue.Close();
  queue.Push(Sample(2.0));
  EXPECT_TRUE(queue.Pop());
  EXPECT_FALSE(queue.Pop());
}

}  // namespace
}  // namespace hv::lio
