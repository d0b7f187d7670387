#include "scan_queue.h"

#include <thread>

#include <gtest/gtest.h>

namespace hv::relocalize {
namespace {

DecodedTrackedScan ScanAt(double seconds, std::size_t points = 3) {
  DecodedTrackedScan scan;
  scan.header.stamp = Time::FromSeconds(seconds);
  scan.points.resize(points);
  return scan;
}

TEST(ScanQueue, HandsOnOneScanAfterTheOther) {
  ScanQueue queue;
  for (double seconds : {1.0, 2.0}) {
    queue.Push(ScanAt(seconds));
    const auto batch = queue.Pop();
    ASSERT_TRUE(batch.has_value());
    EXPECT_EQ(batch->header.stamp, Time::FromSeconds(seconds));
    EXPECT_EQ(batch->points.size(), 3U);
    EXPECT_TRUE(batch->skipped.empty());
  }
  EXPECT_EQ(queue.dropped(), 0U);
}

TEST(ScanQueue, TheNewestOvertakesWhatWaitsAndKeepsItsPoses) {
  ScanQueue queue;
  for (int i = 1; i <= 4; ++i) queue.Push(ScanAt(i));
  const auto batch = queue.Pop();
  ASSERT_TRUE(batch.has_value());
  EXPECT_EQ(batch->header.stamp, Time::FromSeconds(4.0));
  ASSERT_EQ(batch->skipped.size(), 3U);
  EXPECT_EQ(batch->skipped.front().stamp, Time::FromSeconds(1.0));
  EXPECT_EQ(batch->skipped.back().stamp, Time::FromSeconds(3.0));
  EXPECT_EQ(queue.dropped(), 3U);
}

TEST(ScanQueue, PredictedPosesAreNotKept) {
  ScanQueue queue;
  queue.Push(ScanAt(1.0, 0));
  queue.Push(ScanAt(2.0));
  EXPECT_TRUE(queue.Pop()->skipped.empty());
  EXPECT_EQ(queue.dropped(), 0U);
}

TEST(ScanQueue, KeepsABoundedNumberOfPoses) {
  ScanQueue queue;
  for (int i = 0; i < 1500; ++i) queue.Push(ScanAt(i));
  const auto batch = queue.Pop();
  EXPECT_EQ(batch->skipped.size(), 1000U);
  EXPECT_EQ(batch->skipped.back().stamp, Time::FromSeconds(1498.0));
}

TEST(ScanQueue, ClosingEndsTheWait) {
  ScanQueue queue;
  std::thread closer([&queue] { queue.Close(); });
  EXPECT_FALSE(queue.Pop().has_value());
  closer.join();
  queue.Push(ScanAt(1.0));
  EXPECT_FALSE(queue.Pop().has_value());
}

}  // namespace
}  // namespace hv::relocalize
