#include "depth_message.h"

#include <cstring>
#include <limits>

#include <gtest/gtest.h>

namespace hv::navigation {
namespace {

constexpr std::uint32_t kWidth = 3;
constexpr std::uint32_t kHeight = 2;

sensor_msgs::CameraInfo Info() {
  sensor_msgs::CameraInfo info;
  info.width = kWidth;
  info.height = kHeight;
  info.P = {100.0, 0.0, 1.0, 0.0, 0.0, 110.0, 0.5, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

/// With four bytes behind each row.
template <typename Value>
sensor_msgs::Image ImageOf(const std::string& encoding, const std::vector<Value>& values) {
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(12, 500);
  image.encoding = encoding;
  image.width = kWidth;
  image.height = kHeight;
  image.step = kWidth * sizeof(Value) + 4;
  image.data.resize(image.step * kHeight);
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::memcpy(&image.data[i / kWidth * image.step + i % kWidth * sizeof(Value)], &values[i],
                sizeof(Value));
  }
  return image;
}

const std::vector<std::uint16_t> kMillimetres = {1, 2, 3, 1000, 2000, 65535};

TEST(DepthMessage, MillimetresAreTakenAsTheyAre) {
  const DecodedDepth depth = FromMessages(ImageOf("16UC1", kMillimetres), Info());
  EXPECT_EQ(depth.error, "");
  EXPECT_EQ(depth.image.depth_mm, kMillimetres);
  EXPECT_EQ(depth.image.stamp, Time::FromNanoseconds(12'000'000'500));
  EXPECT_EQ(depth.image.width, 3);
  EXPECT_EQ(depth.image.height, 2);
  EXPECT_EQ(depth.camera.fx, 100.0);
  EXPECT_EQ(depth.camera.fy, 110.0);
  EXPECT_EQ(depth.camera.cx, 1.0);
  EXPECT_EQ(depth.camera.cy, 0.5);
}

TEST(DepthMessage, MetresAreRoundedAndNonsenseIsUnknown) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const std::vector<float> metres = {1.2344F, kNan, kInfinite, -1.0F, 70.0F, 0.0F};
  const DecodedDepth depth = FromMessages(ImageOf("32FC1", metres), Info());
  EXPECT_EQ(depth.error, "");
  EXPECT_EQ(depth.image.depth_mm, (std::vector<std::uint16_t>{1234, 0, 0, 0, 0, 0}));
}

TEST(DepthMessage, BothOrdersOfBytes) {
  sensor_msgs::Image image = ImageOf("16UC1", kMillimetres);
  for (std::size_t i = 0; i + 1 < image.data.size(); i += 2) {
    std::swap(image.data[i], image.data[i + 1]);
  }
  image.is_bigendian = 1;
  EXPECT_EQ(FromMessages(image, Info()).image.depth_mm, kMillimetres);
}

TEST(DepthMessage, TheMatrixOfTheRawImageStandsInForAnEmptyOne) {
  sensor_msgs::CameraInfo info = Info();
  info.P.fill(0.0);
  info.K = {90.0, 0.0, 1.5, 0.0, 91.0, 0.75, 0.0, 0.0, 1.0};
  const DepthCameraModel camera = FromMessages(ImageOf("16UC1", kMillimetres), info).camera;
  EXPECT_EQ(camera.fx, 90.0);
  EXPECT_EQ(camera.cy, 0.75);
}

TEST(DepthMessage, WhatIsWrongIsSaid) {
  const sensor_msgs::Image good = ImageOf("16UC1", kMillimetres);
  sensor_msgs::Image colour = good;
  colour.encoding = "rgb8";
  sensor_msgs::Image cut = good;
  cut.data.pop_back();
  sensor_msgs::Image narrow = good;
  narrow.step = 2;
  sensor_msgs::Image huge = good;
  huge.width = huge.height = std::numeric_limits<std::uint32_t>::max();
  sensor_msgs::CameraInfo huge_info = Info();
  huge_info.width = huge_info.height = huge.width;
  sensor_msgs::CameraInfo other_size = Info();
  other_size.width = 640;
  sensor_msgs::CameraInfo blind = Info();
  blind.P.fill(std::numeric_limits<double>::quiet_NaN());
  const auto error = [](const auto& image, const auto& info) {
    return FromMessages(image, info).error;
  };
  EXPECT_NE(error(colour, Info()).find("rgb8"), std::string::npos);
  EXPECT_NE(error(cut, Info()).find("contradict"), std::string::npos);
  EXPECT_NE(error(narrow, Info()).find("contradict"), std::string::npos);
  EXPECT_NE(error(huge, huge_info).find("pixels"), std::string::npos);
  EXPECT_NE(error(good, other_size).find("another size"), std::string::npos);
  EXPECT_NE(error(good, blind).find("focal"), std::string::npos);
}

}  // namespace
}  // namespace hv::navigation
