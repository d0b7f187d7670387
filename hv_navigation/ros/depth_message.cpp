#include "depth_message.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "hv_ros/conversions.h"

namespace hv::navigation {
namespace {

constexpr std::uint32_t kMostPixels = 4096 * 4096;

bool HostIsBigEndian() {
  const std::uint16_t one = 1;
  std::uint8_t first = 0;
  std::memcpy(&first, &one, 1);
  return first == 0;
}

template <typename Value>
Value ValueAt(const std::uint8_t* bytes, bool swap) {
  std::uint8_t ordered[sizeof(Value)];
  std::copy_n(bytes, sizeof(Value), ordered);
  if (swap) std::reverse(ordered, ordered + sizeof(Value));
  Value value;
  std::memcpy(&value, ordered, sizeof(Value));
  return value;
}

/// 0, which is unknown, for what cannot be told in millimetres.
std::uint16_t Millimetres(float metres) {
  constexpr float kMost = std::numeric_limits<std::uint16_t>::max();
  const float millimetres = 1000.0F * metres;
  return millimetres > 0.0F && millimetres < kMost
             ? static_cast<std::uint16_t>(std::lround(millimetres))
             : std::uint16_t{0};
}

/// Returns what is wrong, or nothing.
std::string ReadImage(const sensor_msgs::Image& message, DepthImage& image) {
  const bool in_metres = message.encoding == "32FC1";
  const bool known = in_metres || message.encoding == "16UC1" || message.encoding == "mono16";
  if (!known) return "its encoding is '" + message.encoding + "', not 16UC1 or 32FC1";
  const std::size_t pixel = in_metres ? sizeof(float) : sizeof(std::uint16_t);
  const std::uint64_t pixels = std::uint64_t{message.width} * message.height;
  if (pixels == 0 || pixels > kMostPixels) return "it has no pixels, or far too many";
  const bool fits = message.step >= message.width * pixel &&
                    message.data.size() >= std::uint64_t{message.step} * message.height;
  if (!fits) return "size and data contradict";
  image.stamp = FromRos(message.header.stamp);
  image.width = static_cast<int>(message.width);
  image.height = static_cast<int>(message.height);
  image.depth_mm.reserve(pixels);
  const bool swap = (message.is_bigendian != 0) != HostIsBigEndian();
  for (std::size_t row = 0; row < message.height; ++row) {
    const std::uint8_t* bytes = &message.data[row * message.step];
    for (std::size_t column = 0; column < message.width; ++column, bytes += pixel) {
      image.depth_mm.push_back(in_metres ? Millimetres(ValueAt<float>(bytes, swap))
                                         : ValueAt<std::uint16_t>(bytes, swap));
    }
  }
  return "";
}

/// Of the rectified image; the matrix of the raw one where the other is not filled.
std::string ReadCamera(const sensor_msgs::CameraInfo& info, const sensor_msgs::Image& image,
                       DepthCameraModel& camera) {
  if (info.width != image.width || info.height != image.height) {
    return "its camera_info is of an image of another size";
  }
  camera = {info.P[0], info.P[5], info.P[2], info.P[6]};
  if (camera.fx == 0.0) camera = {info.K[0], info.K[4], info.K[2], info.K[5]};
  const bool usable = std::isfinite(camera.fx) && std::isfinite(camera.fy) &&
                      std::isfinite(camera.cx) && std::isfinite(camera.cy) && camera.fx > 0.0 &&
                      camera.fy > 0.0;
  return usable ? "" : "its camera_info has no focal lengths";
}

}  // namespace

DecodedDepth FromMessages(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& camera) {
  DecodedDepth decoded;
  decoded.error = ReadCamera(camera, image, decoded.camera);
  if (decoded.error.empty()) decoded.error = ReadImage(image, decoded.image);
  return decoded;
}

}  // namespace hv::navigation
