#include "hv_core/point_cloud_decoder.h"

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "sweep_cloud.h"

namespace hv {
namespace {

TEST(Decoder, RefusesInvalidConfiguration) {
  PointCloudDecoderConfig config;
  config.point_stride = 0;
  EXPECT_THROW(PointCloudDecoder{config}, InputError);
  config = {};
  config.time_unit = "minutes";
  EXPECT_THROW(PointCloudDecoder{config}, InputError);
}

TEST(Decoder, DropsNotFiniteAndOutOfRangePointsAndCountsThem) {
  Cloud cloud =
      Sweep<float>("time", FieldType::kFloat32, [](double t) { return static_cast<float>(t); });
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
  Cloud cloud =
      Sweep<float>("time", FieldType::kFloat32, [](double t) { return static_cast<float>(t); });
  cloud.PutXyz(0, 63.9F, 0.0F, 0.0F);
  cloud.PutXyz(1, 0.0F, -119.5F, 2.0F);
  PointCloudDecoder decoder({});
  const DecodedScan decoded = decoder.Decode(cloud.view);
  EXPECT_EQ(decoded.scan.points[0].x, 63.9F);
  EXPECT_EQ(decoded.scan.points[1].y, -119.5F);
}

TEST(Decoder, StrideKeepsEveryRingEvenly) {
  Cloud cloud =
      Sweep<float>("time", FieldType::kFloat32, [](double t) { return static_cast<float>(t); });
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
    Cloud cloud =
        Sweep<float>("time", FieldType::kFloat32, [](double t) { return static_cast<float>(t); });
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
  Cloud cloud =
      Sweep<float>("time", FieldType::kFloat32, [](double t) { return static_cast<float>(t); });
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
  EXPECT_NE(
      error_of([](auto& v) { v.width = 0xFFFFFFFF, v.height = 0xFFFFFFFF; }).find("does not hold"),
      std::string::npos);
  EXPECT_EQ(error_of([](auto& v) { v.fields[2].name = "w"; }),
            "no usable fields x, y, z (fields: x, y, w, intensity, time, ring)");
  EXPECT_NE(error_of([](auto& v) { v.fields[0].offset = 23; }).find("x, y, z"), std::string::npos);
  EXPECT_NE(error_of([](auto& v) { v.fields[0].offset = 0xFFFFFFFF; }).find("x, y, z"),
            std::string::npos);
  EXPECT_NE(error_of([](auto& v) { v.fields[0].type = FieldType::kUint16; }).find("float32"),
            std::string::npos);
  EXPECT_NE(
      error_of([](auto& v) { v.fields[0].type = static_cast<FieldType>(77); }).find("x, y, z"),
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
      cloud.view.fields = {{"x", 0, FieldType::kFloat32},
                           {"y", 4, FieldType::kFloat32},
                           {"z", 8, FieldType::kFloat32},
                           {"time", 16, static_cast<FieldType>(type)}};
      for (std::uint8_t& value : cloud.bytes) value = static_cast<std::uint8_t>(byte(random));
      for (std::size_t i = 0; i < 400; ++i)
        cloud.PutXyz(i, 3.0F, 4.0F, static_cast<float>(i) * 0.01F);
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
