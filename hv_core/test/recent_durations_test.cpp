#include "hv_core/recent_durations.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace hv {
namespace {

TEST(RecentDurations, AreZeroBeforeTheFirst) {
  const RecentDurations durations(3);
  EXPECT_EQ(durations.Quantile_ms(0.5), 0.0);
  EXPECT_EQ(durations.Mean_ms(), 0.0);
  EXPECT_EQ(durations.longest_ms(), 0.0);
}

TEST(RecentDurations, QuantileIsTheShortestThatTheShareDoesNotExceed) {
  RecentDurations durations(1000);
  std::vector<double> all;
  for (int i = 0; i < 200; ++i) {
    all.push_back(static_cast<double>((i * 83) % 200 + 1));
    durations.Add(all.back());
  }
  std::sort(all.begin(), all.end());
  for (const double share : {0.0, 0.005, 0.5, 0.99, 0.991, 1.0}) {
    const double quantile = durations.Quantile_ms(share);
    const auto within = [&](double limit) {
      return static_cast<double>(std::upper_bound(all.begin(), all.end(), limit) - all.begin()) /
             200.0;
    };
    EXPECT_GE(within(quantile), share);
    if (quantile > 1.0) {
      EXPECT_LT(within(quantile - 1.0), share) << share;
    }
  }
  EXPECT_DOUBLE_EQ(durations.Mean_ms(), 100.5);
}

TEST(RecentDurations, ForgetsTheOldestButForTheLongest) {
  RecentDurations durations(3);
  for (const double duration_ms : {90.0, 1.0, 2.0, 3.0}) durations.Add(duration_ms);
  EXPECT_EQ(durations.Quantile_ms(1.0), 3.0);
  EXPECT_EQ(durations.Quantile_ms(0.0), 1.0);
  EXPECT_EQ(durations.Mean_ms(), 2.0);
  EXPECT_EQ(durations.longest_ms(), 90.0);
}

}  // namespace
}  // namespace hv
