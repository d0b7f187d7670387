#include "hv_lio/imu_buffer.h"

#include <gtest/gtest.h>

namespace hv::lio {
namespace {

ImuBuffer RampBuffer(double from, double to, double rate) {
  ImuBuffer buffer(ImuNoiseConfig(), 0.05);
  for (int i = 0; from + i / rate <= to + 1e-9; ++i) {
    ImuSample sample;
    sample.stamp = Time::FromSeconds(from + i / rate);
    sample.angular_velocity.z() = from + i / rate;
    sample.acceleration.x() = 1.0;
    buffer.Add(sample);
  }
  return buffer;
}

double TotalDuration(const std::vector<ImuStep>& steps) {
  double total = 0.0;
  for (const ImuStep& step : steps) total += step.dt;
  return total;
}

TEST(ImuBufferTest, StepsCoverTheIntervalAndIntegrateALinearSignalExactly) {
  const ImuBuffer buffer = RampBuffer(0.0, 1.0, 100.0);
  const auto steps = buffer.Steps(Time::FromSeconds(0.1234), Time::FromSeconds(0.8765), 2.0);
  EXPECT_NEAR(TotalDuration(steps), 0.7531, 1e-9);
  double turned = 0.0;
  for (const ImuStep& step : steps) {
    turned += step.dt * step.angular_velocity.z();
    EXPECT_EQ(step.acceleration.x(), 2.0);
    EXPECT_EQ(step.quality, ImuQuality::kMeasured);
  }
  EXPECT_NEAR(turned, 0.5 * (0.8765 * 0.8765 - 0.1234 * 0.1234), 1e-9);
}

TEST(ImuBufferTest, GapsAreDividedAndMarked) {
  ImuBuffer buffer = RampBuffer(0.0, 0.2, 100.0);
  ImuSample late;
  late.stamp = Time::FromSeconds(0.5);
  buffer.Add(late);
  const auto steps = buffer.Steps(Time::FromSeconds(0.15), Time::FromSeconds(0.45), 1.0);
  EXPECT_NEAR(TotalDuration(steps), 0.3, 1e-9);
  EXPECT_EQ(steps.front().quality, ImuQuality::kMeasured);
  EXPECT_EQ(steps.back().quality, ImuQuality::kMissing);
  for (const ImuStep& step : steps) EXPECT_LE(step.dt, 0.0201);
  EXPECT_NEAR(buffer.LongestGap(Time::FromSeconds(0.15), Time::FromSeconds(0.45)), 0.25, 1e-9);
}

TEST(ImuBufferTest, HoldsTheReadingBeyondTheSamples) {
  const ImuBuffer buffer = RampBuffer(0.0, 0.2, 100.0);
  const auto steps = buffer.Steps(Time::FromSeconds(0.1), Time::FromSeconds(0.4), 1.0);
  EXPECT_NEAR(TotalDuration(steps), 0.3, 1e-9);
  EXPECT_NEAR(steps.back().angular_velocity.z(), 0.2, 1e-9);
  EXPECT_EQ(steps.back().quality, ImuQuality::kMissing);
  EXPECT_TRUE(buffer.Steps(Time::FromSeconds(0.2), Time::FromSeconds(0.1), 1.0).empty());
}

TEST(ImuBufferTest, SortsLateSamplesAndRefusesDuplicates) {
  ImuBuffer buffer = RampBuffer(0.0, 0.1, 100.0);
  ImuSample sample;
  sample.stamp = Time::FromSeconds(0.055);
  EXPECT_TRUE(buffer.Add(sample));
  EXPECT_FALSE(buffer.Add(sample));
  for (std::size_t i = 1; i < buffer.samples().size(); ++i) {
    EXPECT_LT(buffer.samples()[i - 1].stamp, buffer.samples()[i].stamp);
  }
}

TEST(ImuBufferTest, SaturatedReadingsAreMarked) {
  ImuNoiseConfig noise;
  noise.gyro_limit = 1.0;
  ImuBuffer buffer(noise, 0.05);
  for (int i = 0; i < 10; ++i) {
    ImuSample sample;
    sample.stamp = Time::FromSeconds(0.01 * i);
    sample.angular_velocity.x() = i < 5 ? 0.0 : -1.0;
    buffer.Add(sample);
  }
  const auto steps = buffer.Steps(Time::FromSeconds(0.0), Time::FromSeconds(0.09), 1.0);
  EXPECT_EQ(steps.front().quality, ImuQuality::kMeasured);
  EXPECT_EQ(steps.back().quality, ImuQuality::kSaturated);
}

TEST(ImuBufferTest, DropKeepsTheSampleThatBeginsTheInterval) {
  ImuBuffer buffer = RampBuffer(0.0, 0.1, 100.0);
  buffer.DropBefore(Time::FromSeconds(0.055));
  EXPECT_NEAR(buffer.samples().front().stamp.seconds(), 0.05, 1e-9);
}

}  // namespace
}  // namespace hv::lio
