#include "hv_core/point_cloud_decoder.h"

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace hv {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::int64_t kEpochNs = 1646310000123456789;
constexpr int kColumns = 500;
constexpr int kRings = 32;
constexpr double kColumnPeriod = 0.1 / kColumns;

double FiringTime(int column, int ring) { return column * kColumnPeriod + ring * 1.5e-6; }
constexpr double kLastFiring = (kColumns - 1) * (0.1 / kColumns) + (kRings - 1) * 1.5e-6;

/// Owns the bytes of a cloud and writes fields into them.
struct Cloud {
  std::vector<std::uint8_t> bytes;
  PointCloudView view;

  Cloud(std::uint32_t width, std::uint32_t height, std::uint32_t point_step)
      : bytes(std::size_t{width} * height * point_step) {
    view.stamp = Time::FromNanoseconds(kEpochNs);
    view.width = width;
    view.height = height;
    view.point_step = point_step;
    view.row_step = width * point_step;
    view.data = bytes.data();
    view.size = bytes.size();
  }

  template <typename T>
  void Put(std::size_t point, std::uint32_t offset, T value) {
    std::memcpy(bytes.data() + point * view.point_step + offset, &value, sizeof(T));
  }

  void PutXyz(std::size_t point, float x, float y, float z) {
    Put(point, 0, x);
    Put(point, 4, y);
    Put(point, 8, z);
  }
};

/// A sweep in firing order, seen clockwise from above; `time_value` turns the firing time [s] after
/// the first point into the driver's value.
template <typename T>
Cloud Sweep(const std::string& time_name, FieldType type, std::function<T(double)> time_value) {
  Cloud cloud(kColumns * kRings, 1, 26);
  cloud.view.fields = {{"x", 0, FieldType::kFloat32},
                       {"y", 4, FieldType::kFloat32},
                       {"z", 8, FieldType::kFloat32},
                       {"intensity", 12, FieldType::kFloat32},
                       {time_name, 16, type},
                       {"ring", 24, FieldType::kUint16}};
  std::size_t index = 0;
  for (int column = 0; column < kColumns; ++column) {
    const double azimuth = 1.0 - 2.0 * kPi * column / kColumns;
    for (int ring = 0; ring < kRings; ++ring, ++index) {
      const float range = 5.0F + static_cast<float>(ring);
      cloud.PutXyz(index, range * static_cast<float>(std::cos(azimuth)),
                   range * static_cast<float>(std::sin(azimuth)), 0.1F * static_cast<float>(ring));
      cloud.Put(index, 12, static_cast<float>(ring) * 2.0F);
      cloud.Put(index, 16, time_value(FiringTime(column, ring)));
      cloud.Put(index, 24, static_cast<std::uint16_t>(ring));
    }
  }
  return cloud;
}

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

const Time kStart = Time::FromNanoseconds(kEpochNs);

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
  Cloud cloud = Sweep<float>("time", FieldType::kFloat32,
                             [](double t) { return static_cast<float>(t); });
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
  Cloud positive = Sweep<float>("time", FieldType::kFloat32,
                                [](double t) { return static_cast<float>(t); });
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
  Cloud cloud = Sweep<double>("timestamp", FieldType::kFloat64, [](double t) { return 5000.0 + t; });
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
  Cloud cloud = Sweep<float>("time", FieldType::kFloat32,
                             [](double t) { return static_cast<float>(t); });
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
  Cloud cloud = Sweep<float>("time", FieldType::kFloat32,
                             [](double t) { return static_cast<float>(t); });
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
    Cloud cloud = Sweep<float>("time", FieldType::kFloat32,
                               [](double t) { return static_cast<float>(t); });
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
  Cloud cloud = Sweep<float>("time", FieldType::kFloat32,
                             [](double t) { return static_cast<float>(t); });
  decoder.Decode(cloud.view);
  Cloud without = SweepWithoutTime();
  const DecodedScan decoded = decoder.Decode(without.view);
  EXPECT_EQ(decoded.error,
            "no time field 'time' (fields: x, y, z, intensity, unused, ring)");
  EXPECT_TRUE(decoded.scan.points.empty());
}

TEST(Decoder, RefusesInvalidConfiguration) {
  PointCloudDecoderConfig config;
  config.point_stride = 0;
  EXPECT_THROW(PointCloudDecoder{config}, InputError);
  config = {};
  config.time_unit = "minutes";
  EXPECT_THROW(PointCloudDecoder{config}, InputError);
}

TEST(Decoder, DropsNotFiniteAndOutOfRangePointsAndCountsThem) {
  Cloud cloud = Sweep<float>("time", FieldType::kFloat32,
                             [](double t) { return static_cast<float>(t); });
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  cloud.PutXyz(10, nan, 1.0F, 1.0F);
  cloud.PutXyz(11, 1.0F, 1.0F, -infinity);
  cloud.PutXyz(12, 0.1F, 0.1F, 0.1F);
  cloud.PutXyz(13, 0.0F, 0.0F, 0.0F);
  cloud.PutXyz(14, 121.0F, 0.0F, 0.0F);
  cloud.PutXyz(15, 1e30F, 0.0F, 0.0F);
  PointCloudDecoder decoder({});
  const DecodedScan decoded = decoder.Decode(cloud.view);
  EXPECT_EQ(decoded.points_in, static_cast<std::size_t>(kColumns * kRings));
  EXPECT_EQ(decoded.not_finite, 2U);
  EXPECT_EQ(decoded.out_of_range, 4U);
  EXPECT_EQ(decoded.scan.points.size(), decoded.points_in - 6);
}

TEST(Decoder, KeepsValuesBeyond63Metres) {
  Cloud cloud = Sweep<float>("time", FieldType::kFloat32,
                             [](double t) { return static_cast<float>(t); });
  cloud.PutXyz(0, 63.9F, 0.0F, 0.0F);
  cloud.PutXyz(1, 0.0F, -119.5F, 2.0F);
  PointCloudDecoder decoder({});
  const DecodedScan decoded = decoder.Decode(cloud.view);
  EXPECT_EQ(decoded.scan.points[0].x, 63.9F);
  EXPECT_EQ(decoded.scan.points[1].y, -119.5F);
}

TEST(Decoder, StrideKeepsEveryRingEvenly) {
  Cloud cloud = Sweep<float>("time", FieldType::kFloat32,
                             [](double t) { return static_cast<float>(t); });
  for (const int stride : {2, 3, 4, 8, 16, 32}) {
    for (const bool has_ring : {true, false}) {
      cloud.view.fields.back().name = has_ring ? "ring" : "unused";
      PointCloudDecoderConfig config;
      config.point_stride = stride;
      PointCloudDecoder decoder(config);
      const DecodedScan decoded = decoder.Decode(cloud.view);
      std::map<float, int> per_ring;
      for (const Point& point : decoded.scan.points) ++per_ring[point.intensity];
      ASSERT_EQ(per_ring.size(), static_cast<std::size_t>(kRings)) << stride;
      for (const auto& [ring, count] : per_ring) {
        EXPECT_NEAR(count, kColumns / stride, has_ring ? 1.0 : 5.0) << stride << " " << ring;
      }
    }
  }
}

TEST(Decoder, ReadsRingOfAnyType) {
  const std::map<FieldType, std::function<void(Cloud&, std::size_t, int)>> writers = {
      {FieldType::kUint8, [](Cloud& c, std::size_t i, int r) { c.Put(i, 20, std::uint8_t(r)); }},
      {FieldType::kInt8, [](Cloud& c, std::size_t i, int r) { c.Put(i, 20, std::int8_t(r)); }},
      {FieldType::kUint16, [](Cloud& c, std::size_t i, int r) { c.Put(i, 20, std::uint16_t(r)); }},
      {FieldType::kInt32, [](Cloud& c, std::size_t i, int r) { c.Put(i, 20, std::int32_t(r)); }},
      {FieldType::kFloat32, [](Cloud& c, std::size_t i, int r) { c.Put(i, 20, float(r)); }}};
  for (const auto& [type, write] : writers) {
    Cloud cloud = Sweep<float>("time", FieldType::kFloat32,
                               [](double t) { return static_cast<float>(t); });
    cloud.view.fields.back() = {"ring", 20, type};
    for (int i = 0; i < kColumns * kRings; ++i) {
      write(cloud, static_cast<std::size_t>(i), i % kRings);
    }
    PointCloudDecoder decoder({});
    const DecodedScan decoded = decoder.Decode(cloud.view);
    EXPECT_EQ(decoded.scan.points[31].ring, 31) << static_cast<int>(type);
  }
}

TEST(Decoder, ReadsDoubleCoordinatesAndPaddedRows) {
  Cloud cloud(2, 2, 32);
  cloud.bytes.assign(200, 0xFF);
  cloud.view.data = cloud.bytes.data();
  cloud.view.size = cloud.bytes.size();
  cloud.view.row_step = 100;
  cloud.view.fields = {{"x", 8, FieldType::kFloat64},
                       {"y", 16, FieldType::kFloat64},
                       {"z", 24, FieldType::kFloat64}};
  for (std::size_t i = 0; i < 4; ++i) {
    std::uint8_t* point = cloud.bytes.data() + (i / 2) * 100 + (i % 2) * 32;
    const double xyz[3] = {1.0 + static_cast<double>(i), 2.0, 3.0};
    std::memcpy(point + 8, xyz, sizeof(xyz));
  }
  PointCloudDecoder decoder({});
  const DecodedScan decoded = decoder.Decode(cloud.view);
  ASSERT_EQ(decoded.scan.points.size(), 4U);
  EXPECT_EQ(decoded.scan.points[3].x, 4.0F);
}

TEST(Decoder, EmptyCloudIsAnEmptyScanWithoutError) {
  Cloud cloud(0, 0, 26);
  PointCloudDecoder decoder({});
  const DecodedScan decoded = decoder.Decode(cloud.view);
  EXPECT_EQ(decoded.error, "");
  EXPECT_TRUE(decoded.scan.points.empty());
  EXPECT_EQ(decoded.scan.stamp, kStart);
}

TEST(Decoder, UnusableCloudsAreErrors) {
  Cloud cloud = Sweep<float>("time", FieldType::kFloat32,
                             [](double t) { return static_cast<float>(t); });
  const auto error_of = [&cloud](const std::function<void(PointCloudView&)>& spoil) {
    PointCloudView view = cloud.view;
    spoil(view);
    PointCloudDecoder decoder({});
    const DecodedScan decoded = decoder.Decode(view);
    EXPECT_TRUE(decoded.scan.points.empty());
    return decoded.error;
  };
  EXPECT_NE(error_of([](auto& v) { v.is_bigendian = true; }).find("big-endian"), std::string::npos);
  EXPECT_NE(error_of([](auto& v) { v.point_step = 0; }).find("point_step"), std::string::npos);
  EXPECT_NE(error_of([](auto& v) { v.size -= 1; }).find("does not hold"), std::string::npos);
  EXPECT_NE(error_of([](auto& v) { v.data = nullptr; }).find("does not hold"), std::string::npos);
  EXPECT_NE(error_of([](auto& v) { v.height = 2; }).find("does not hold"), std::string::npos);
  EXPECT_NE(error_of([](auto& v) { v.height = 1000, v.row_step = 0; }).find("does not hold"),
            std::string::npos);
  EXPECT_NE(error_of([](auto& v) { v.width = 0xFFFFFFFF, v.height = 0xFFFFFFFF; })
                .find("does not hold"), std::string::npos);
  EXPECT_EQ(error_of([](auto& v) { v.fields[2].name = "w"; }),
            "no usable fields x, y, z (fields: x, y, w, intensity, time, ring)");
  EXPECT_NE(error_of([](auto& v) { v.fields[0].offset = 23; }).find("x, y, z"), std::string::npos);
  EXPECT_NE(error_of([](auto& v) { v.fields[0].offset = 0xFFFFFFFF; }).find("x, y, z"),
            std::string::npos);
  EXPECT_NE(error_of([](auto& v) { v.fields[0].type = FieldType::kUint16; }).find("float32"),
            std::string::npos);
  EXPECT_NE(error_of([](auto& v) { v.fields[0].type = static_cast<FieldType>(77); }).find("x, y, z"),
            std::string::npos);
}

TEST(Decoder, AnyBytesAndAnySizesAreSurvived) {
  std::mt19937 random(42);
  std::uniform_int_distribution<int> byte(0, 255);
  std::uniform_int_distribution<std::uint32_t> small(0, 40);
  std::uniform_int_distribution<int> type(0, 10);
  const char* names[] = {"x", "y", "z", "t", "time", "timestamp", "ring", "intensity"};
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::uint8_t> bytes(small(random) * small(random));
    for (std::uint8_t& value : bytes) value = static_cast<std::uint8_t>(byte(random));
    PointCloudView view;
    for (const char* name : names) {
      view.fields.push_back({name, small(random), static_cast<FieldType>(type(random))});
    }
    if (round % 2 == 0) {
      for (std::uint32_t k = 0; k < 3; ++k) view.fields[k] = {names[k], 4 * k, FieldType::kFloat32};
    }
    view.width = small(random);
    view.height = round % 3 == 0 ? 1 : small(random);
    view.point_step = small(random);
    view.row_step = round % 5 == 0 ? small(random) : view.width * view.point_step;
    view.data = bytes.data();
    view.size = bytes.size();
    PointCloudDecoderConfig config;
    config.point_stride = 1 + round % 3;
    PointCloudDecoder decoder(config);
    for (int repeat = 0; repeat < 12; ++repeat) {
      const DecodedScan decoded = decoder.Decode(view);
      for (const Point& point : decoded.scan.points) {
        ASSERT_TRUE(std::isfinite(point.x + point.y + point.z + point.intensity + point.time));
        ASSERT_GE(point.time, 0.0F);
      }
    }
  }
}

TEST(Decoder, AnyPayloadInAValidLayoutIsSurvived) {
  std::mt19937 random(43);
  std::uniform_int_distribution<int> byte(0, 255);
  for (int type = 1; type <= 8; ++type) {
    for (int round = 0; round < 20; ++round) {
      Cloud cloud(400, 1, 26);
      cloud.view.fields = {{"x", 0, FieldType::kFloat32}, {"y", 4, FieldType::kFloat32},
                           {"z", 8, FieldType::kFloat32}, {"time", 16, static_cast<FieldType>(type)}};
      for (std::uint8_t& value : cloud.bytes) value = static_cast<std::uint8_t>(byte(random));
      for (std::size_t i = 0; i < 400; ++i) cloud.PutXyz(i, 3.0F, 4.0F, static_cast<float>(i) * 0.01F);
      PointCloudDecoder decoder({});
      for (int repeat = 0; repeat < 12; ++repeat) {
        const DecodedScan decoded = decoder.Decode(cloud.view);
        EXPECT_EQ(decoded.points_in, 400U);
        EXPECT_EQ(decoded.scan.points.size() + decoded.bad_time, 400U);
      }
    }
  }
}

struct FakeMessage {
  struct {
    struct {
      std::uint64_t toNSec() const { return static_cast<std::uint64_t>(kEpochNs); }
    } stamp;
  } header;
  struct Field {
    std::string name;
    std::uint32_t offset;
    std::uint8_t datatype;
  };
  std::vector<Field> fields = {{"x", 0, 7}};
  std::uint32_t width = 1, height = 1, point_step = 4, row_step = 4;
  std::uint8_t is_bigendian = 0;
  std::vector<std::uint8_t> data = {0, 0, 0, 0};
};

TEST(Decoder, ViewOfCopiesTheDescription) {
  const FakeMessage message;
  const PointCloudView view = ViewOf(message);
  EXPECT_EQ(view.stamp.nanoseconds(), kEpochNs);
  ASSERT_EQ(view.fields.size(), 1U);
  EXPECT_EQ(view.fields[0].type, FieldType::kFloat32);
  EXPECT_EQ(view.size, 4U);
}

}  // namespace
}  // namespace hv
