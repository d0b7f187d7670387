#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "hv_core/point_cloud_decoder.h"
#include "sweep_cloud.h"

namespace hv {
namespace {

/// Checks times and rings of a decoded Sweep, and that it starts at `start`.
void ExpectSweep(const DecodedScan& decoded, Time start, double tolerance) {
  ASSERT_EQ(decoded.error, "");
  ASSERT_EQ(decoded.scan.points.size(), static_cast<std::size_t>(kColumns * kRings));
  EXPECT_NEAR(decoded.scan.stamp - start, 0.0, tolerance);
  EXPECT_NEAR(decoded.scan.duration, kLastFiring, tolerance);
  std::size_t index = 0;
  for (int column = 0; column < kColumns; ++column) {
    for (int ring = 0; ring < kRings; ++ring, ++index) {
      const Point& point = decoded.scan.points[index];
      ASSERT_NEAR(point.time, FiringTime(column, ring), tolerance);
      ASSERT_GE(point.time, 0.0F);
      ASSERT_EQ(point.ring, ring);
      ASSERT_EQ(point.intensity, static_cast<float>(ring) * 2.0F);
    }
  }
}

TEST(PointTime, HesaiAbsoluteSecondsWithHeaderAtBegin) {
  Cloud cloud = Sweep<double>("timestamp", FieldType::kFloat64,
                              [](double t) { return kStart.seconds() + t; });
  PointCloudDecoder decoder({});
  ExpectSweep(decoder.Decode(cloud.view), kStart, 1e-6);
  ASSERT_TRUE(decoder.time_layout().has_value());
  EXPECT_TRUE(decoder.time_layout()->absolute);
  EXPECT_FALSE(decoder.time_layout()->stamp_at_end);
  EXPECT_EQ(decoder.time_layout()->unit_s, 1.0);
  EXPECT_EQ(decoder.time_layout()->ToString(),
            "point time: field 'timestamp', absolute, in s, header stamp at the first point");
}

TEST(PointTime, HesaiAbsoluteSecondsWithHeaderAtEnd) {
  Cloud cloud = Sweep<double>("timestamp", FieldType::kFloat64,
                              [](double t) { return kStart.seconds() + t; });
  cloud.view.stamp = kStart + kLastFiring;
  PointCloudDecoder decoder({});
  ExpectSweep(decoder.Decode(cloud.view), kStart, 1e-6);
  EXPECT_TRUE(decoder.time_layout()->stamp_at_end);
}

TEST(PointTime, AbsoluteNanosecondsInDoubles) {
  Cloud cloud = Sweep<double>("timestamp", FieldType::kFloat64,
                              [](double t) { return kStart.seconds() * 1e9 + t * 1e9; });
  PointCloudDecoder decoder({});
  ExpectSweep(decoder.Decode(cloud.view), kStart, 1e-6);
  EXPECT_EQ(decoder.time_layout()->unit_s, 1e-9);
}

TEST(PointTime, OusterRelativeNanoseconds) {
  Cloud cloud = Sweep<std::uint32_t>("t", FieldType::kUint32, [](double t) {
    return static_cast<std::uint32_t>(std::llround(t * 1e9));
  });
  PointCloudDecoder decoder({});
  ExpectSweep(decoder.Decode(cloud.view), kStart, 1e-8);
  EXPECT_FALSE(decoder.time_layout()->absolute);
  EXPECT_EQ(decoder.time_layout()->unit_s, 1e-9);
}

TEST(PointTime, VelodyneRelativeSecondsFromBegin) {
  Cloud cloud =
      Sweep<float>("time", FieldType::kFloat32, [](double t) { return static_cast<float>(t); });
  PointCloudDecoder decoder({});
  ExpectSweep(decoder.Decode(cloud.view), kStart, 1e-7);
}

TEST(PointTime, VelodyneNegativeSecondsToHeaderAtEnd) {
  Cloud cloud = Sweep<float>("time", FieldType::kFloat32,
                             [](double t) { return static_cast<float>(t - kLastFiring); });
  cloud.view.stamp = kStart + kLastFiring;
  PointCloudDecoder decoder({});
  ExpectSweep(decoder.Decode(cloud.view), kStart, 1e-7);
  EXPECT_TRUE(decoder.time_layout()->stamp_at_end);
  EXPECT_TRUE(decoder.time_layout()->negative);
}

TEST(PointTime, ConfiguredHeaderStampOverrulesTheSign) {
  Cloud positive =
      Sweep<float>("time", FieldType::kFloat32, [](double t) { return static_cast<float>(t); });
  positive.view.stamp = kStart + kLastFiring;
  PointCloudDecoderConfig at_end;
  at_end.header_stamp = "end";
  PointCloudDecoder end_decoder(at_end);
  ExpectSweep(end_decoder.Decode(positive.view), kStart, 1e-7);

  Cloud negative = Sweep<float>("time", FieldType::kFloat32,
                                [](double t) { return static_cast<float>(t - kLastFiring); });
  PointCloudDecoderConfig at_begin;
  at_begin.header_stamp = "begin";
  PointCloudDecoder begin_decoder(at_begin);
  ExpectSweep(begin_decoder.Decode(negative.view), kStart, 1e-7);
}

TEST(PointTime, LivoxOffsetsAndMicroseconds) {
  Cloud nanoseconds = Sweep<std::uint32_t>("offset_time", FieldType::kUint32, [](double t) {
    return static_cast<std::uint32_t>(t * 1e9);
  });
  PointCloudDecoder first({});
  ExpectSweep(first.Decode(nanoseconds.view), kStart, 1e-8);

  Cloud microseconds = Sweep<std::int32_t>("time_stamp", FieldType::kInt32, [](double t) {
    return static_cast<std::int32_t>(std::llround(t * 1e6));
  });
  PointCloudDecoder second({});
  ExpectSweep(second.Decode(microseconds.view), kStart, 1e-6);
  EXPECT_EQ(second.time_layout()->unit_s, 1e-6);
}

TEST(PointTime, MillisecondsAndOtherSweepRates) {
  for (const double period : {0.05, 0.1, 0.2}) {
    Cloud cloud = Sweep<float>("time", FieldType::kFloat32, [period](double t) {
      return static_cast<float>(t * 10.0 * period * 1e3);
    });
    PointCloudDecoderConfig config;
    PointCloudDecoder decoder(config);
    const DecodedScan decoded = decoder.Decode(cloud.view);
    EXPECT_EQ(decoder.time_layout()->unit_s, 1e-3) << period;
    EXPECT_NEAR(decoded.scan.duration, kLastFiring * 10.0 * period, 1e-6);
  }
}

TEST(PointTime, OtherClockFallsBackToTheHeaderWithAWarning) {
  Cloud cloud =
      Sweep<double>("timestamp", FieldType::kFloat64, [](double t) { return 5000.0 + t; });
  PointCloudDecoder decoder({});
  ExpectSweep(decoder.Decode(cloud.view), kStart, 1e-6);
  EXPECT_TRUE(decoder.time_layout()->other_clock);
  EXPECT_NE(decoder.time_layout()->ToString().find("WARNING"), std::string::npos);

  PointCloudDecoderConfig at_end;
  at_end.header_stamp = "end";
  PointCloudDecoder end_decoder(at_end);
  cloud.view.stamp = kStart + kLastFiring;
  ExpectSweep(end_decoder.Decode(cloud.view), kStart, 1e-6);
}

TEST(PointTime, DecisionIsKeptForLaterClouds) {
  PointCloudDecoder decoder({});
  Cloud cloud =
      Sweep<float>("time", FieldType::kFloat32, [](double t) { return static_cast<float>(t); });
  decoder.Decode(cloud.view);
  Cloud quarter = Sweep<float>("time", FieldType::kFloat32,
                               [](double t) { return static_cast<float>(t * 1e-3); });
  const DecodedScan decoded = decoder.Decode(quarter.view);
  EXPECT_EQ(decoder.time_layout()->unit_s, 1.0);
  EXPECT_NEAR(decoded.scan.duration, kLastFiring * 1e-3, 1e-7);
}

TEST(PointTime, CloudsTooShortToJudgeLeaveTheDecisionOpen) {
  PointCloudDecoder decoder({});
  Cloud cloud = Sweep<float>("time", FieldType::kFloat32,
                             [](double t) { return static_cast<float>(t * 1e3); });
  PointCloudView few = cloud.view;
  few.width = 10;
  EXPECT_EQ(decoder.Decode(few).scan.points.size(), 10U);
  EXPECT_FALSE(decoder.time_layout().has_value());
  decoder.Decode(cloud.view);
  ASSERT_TRUE(decoder.time_layout().has_value());
  EXPECT_EQ(decoder.time_layout()->unit_s, 1e-3);
}

TEST(PointTime, ConstantTimesFallBackToAzimuthLoudly) {
  PointCloudDecoder decoder({});
  Cloud cloud = Sweep<float>("time", FieldType::kFloat32, [](double) { return 0.0F; });
  DecodedScan decoded;
  for (int i = 0; i < 12; ++i) decoded = decoder.Decode(cloud.view);
  ASSERT_TRUE(decoder.time_layout().has_value());
  EXPECT_TRUE(decoder.time_layout()->from_azimuth);
  EXPECT_NE(decoder.time_layout()->ToString().find("WARNING"), std::string::npos);
  EXPECT_NEAR(decoded.scan.points[200 * kRings].time, 200 * kColumnPeriod, 1e-4);
}

/// Removes the time field by renaming it.
Cloud SweepWithoutTime() {
  return Sweep<float>("unused", FieldType::kFloat32, [](double) { return 0.0F; });
}

TEST(PointTime, WithoutFieldAzimuthGivesFiringOrderTimes) {
  PointCloudDecoder decoder({});
  Cloud cloud = SweepWithoutTime();
  const DecodedScan decoded = decoder.Decode(cloud.view);
  EXPECT_TRUE(decoder.time_layout()->from_azimuth);
  EXPECT_EQ(decoded.scan.stamp, kStart);
  for (int column = 0; column < kColumns; ++column) {
    ASSERT_NEAR(decoded.scan.points[static_cast<std::size_t>(column * kRings)].time,
                column * kColumnPeriod, 1e-4);
  }
}

TEST(PointTime, AzimuthOfRingByRingClouds) {
  Cloud cloud = SweepWithoutTime();
  Cloud by_ring = cloud;
  by_ring.view.data = by_ring.bytes.data();
  const std::size_t step = cloud.view.point_step;
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      std::memcpy(by_ring.bytes.data() + (ring * kColumns + column) * step,
                  cloud.bytes.data() + (column * kRings + ring) * step, step);
    }
  }
  by_ring.view.width = kColumns;
  by_ring.view.height = kRings;
  by_ring.view.row_step = static_cast<std::uint32_t>(kColumns * step);
  PointCloudDecoder decoder({});
  const DecodedScan decoded = decoder.Decode(by_ring.view);
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    ASSERT_NEAR(decoded.scan.points[ring * kColumns + 300].time, 300 * kColumnPeriod, 1e-4);
  }
}

TEST(PointTime, ZeroPeriodOrNoneMeansDeskewed) {
  Cloud cloud =
      Sweep<float>("time", FieldType::kFloat32, [](double t) { return static_cast<float>(t); });
  PointCloudDecoderConfig zero_period;
  zero_period.scan_period_s = 0.0;
  PointCloudDecoderConfig none;
  none.time_field = "none";
  for (const PointCloudDecoderConfig& config : {zero_period, none}) {
    PointCloudDecoder decoder(config);
    const DecodedScan decoded = decoder.Decode(cloud.view);
    EXPECT_EQ(decoded.scan.stamp, kStart);
    EXPECT_EQ(decoded.scan.duration, 0.0);
    EXPECT_EQ(decoded.scan.points[5000].time, 0.0F);
  }
}

TEST(PointTime, ConfiguredUnitAndFieldAreUsed) {
  Cloud cloud = Sweep<float>("my_time", FieldType::kFloat32,
                             [](double t) { return static_cast<float>(t * 1e6); });
  PointCloudDecoderConfig config;
  config.time_field = "my_time";
  config.time_unit = "us";
  PointCloudDecoder decoder(config);
  ExpectSweep(decoder.Decode(cloud.view), kStart, 1e-6);
}

TEST(PointTime, OutliersAreDroppedAndDoNotMoveTheStamp) {
  for (const float bad : {-7.0F, 1e9F, std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity()}) {
    Cloud cloud =
        Sweep<float>("time", FieldType::kFloat32, [](double t) { return static_cast<float>(t); });
    cloud.Put(0, 16, bad);
    cloud.Put(777, 16, bad);
    PointCloudDecoder decoder({});
    const DecodedScan decoded = decoder.Decode(cloud.view);
    EXPECT_EQ(decoded.bad_time, 2U);
    EXPECT_EQ(decoded.scan.points.size(), static_cast<std::size_t>(kColumns * kRings - 2));
    EXPECT_NEAR(decoded.scan.stamp - kStart, 1.5e-6, 1e-7);
    EXPECT_NEAR(decoded.scan.duration, kLastFiring - 1.5e-6, 1e-7);
  }
}

TEST(PointTime, FieldMissingLaterIsAnError) {
  PointCloudDecoder decoder({});
  Cloud cloud =
      Sweep<float>("time", FieldType::kFloat32, [](double t) { return static_cast<float>(t); });
  decoder.Decode(cloud.view);
  Cloud without = SweepWithoutTime();
  const DecodedScan decoded = decoder.Decode(without.view);
  EXPECT_EQ(decoded.error, "no time field 'time' (fields: x, y, z, intensity, unused, ring)");
  EXPECT_TRUE(decoded.scan.points.empty());
}

}  // namespace
}  // namespace hv
