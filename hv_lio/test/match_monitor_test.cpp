#include "hv_lio/match_monitor.h"

#include <gtest/gtest.h>

namespace hv::lio {
namespace {

UpdateSummary Match(std::size_t residuals, double distance_m) {
  UpdateSummary update;
  update.residuals = residuals;
  update.mean_abs_residual_m = distance_m;
  return update;
}

class MatchMonitorTest : public testing::Test {
 protected:
  void Fit(int scans) {
    for (int i = 0; i < scans; ++i) {
      EXPECT_FALSE(monitor_.IsLost(Match(2900 + 10 * (i % 7), 0.007 + 0.0001 * (i % 3))));
    }
  }
  /// Scans of another place until the monitor says so; -1: never within a hundred.
  int ScansUntilLost(std::size_t residuals, double distance_m) {
    for (int i = 1; i <= 100; ++i) {
      if (monitor_.IsLost(Match(residuals, distance_m))) return i;
    }
    return -1;
  }

  RobustnessConfig config_;
  MatchMonitor monitor_{config_};
};

TEST_F(MatchMonitorTest, AnotherPlaceIsNoticed) {
  Fit(30);
  EXPECT_EQ(ScansUntilLost(500, 0.06), config_.misfit_scans);
}

TEST_F(MatchMonitorTest, FewPointsThatFitAreNotAnotherPlace) {
  Fit(30);
  EXPECT_EQ(ScansUntilLost(300, 0.008), -1);
}

TEST_F(MatchMonitorTest, ARoughPlaceIsNotAnotherPlace) {
  Fit(30);
  EXPECT_EQ(ScansUntilLost(2500, 0.06), -1);
}

TEST_F(MatchMonitorTest, AScanThatFitsStartsTheCountAnew) {
  Fit(30);
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i + 1 < config_.misfit_scans; ++i) {
      EXPECT_FALSE(monitor_.IsLost(Match(500, 0.06)));
    }
    Fit(1);
  }
}

TEST_F(MatchMonitorTest, NothingIsUsualAtTheStart) {
  EXPECT_EQ(ScansUntilLost(500, 0.06), -1);
  monitor_.Restart();
  Fit(30);
  monitor_.Restart();
  EXPECT_EQ(ScansUntilLost(500, 0.06), -1);
}

}  // namespace
}  // namespace hv::lio
