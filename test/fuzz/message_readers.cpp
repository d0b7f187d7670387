#include <fuzzer/FuzzedDataProvider.h>

#include "depth_message.h"
#include "hv_core/point_cloud_decoder.h"
#include "hv_ros/keyframe_message.h"
#include "hv_ros/message_checks.h"
#include "hv_ros/tracked_scan_message.h"
#include "readers.h"

namespace hv::fuzz {
namespace {

constexpr std::size_t kMostData = 2048;

using Source = FuzzedDataProvider;

ros::Time AnyTime(Source& source) {
  return {source.ConsumeIntegral<std::uint32_t>(),
          source.ConsumeIntegralInRange<std::uint32_t>(0, 999999999)};
}

void Fill(Source& source, std_msgs::Header& header) {
  header.stamp = AnyTime(source);
  header.frame_id = source.ConsumeRandomLengthString(8);
}

template <typename Vector>
void FillVector(Source& source, Vector& vector) {
  vector.x = source.ConsumeFloatingPoint<double>();
  vector.y = source.ConsumeFloatingPoint<double>();
  vector.z = source.ConsumeFloatingPoint<double>();
}

void Fill(Source& source, geometry_msgs::Pose& pose) {
  FillVector(source, pose.position);
  if (source.ConsumeBool()) {
    pose.orientation.w = 1.0;
    return;
  }
  FillVector(source, pose.orientation);
  pose.orientation.w = source.ConsumeFloatingPoint<double>();
}

std::vector<std::uint8_t> AnyData(Source& source) {
  return source.ConsumeBytes<std::uint8_t>(
      source.ConsumeIntegralInRange<std::size_t>(0, kMostData));
}

void Fill(Source& source, sensor_msgs::PointCloud2& cloud) {
  static const std::vector<std::string> names = {
      "x", "y",    "z",           "intensity",  "timestamp",   "time",
      "t", "ring", "offset_time", "time_stamp", "reflectivity"};
  Fill(source, cloud.header);
  for (int left = source.ConsumeIntegralInRange(0, 9); left > 0; --left) {
    sensor_msgs::PointField field;
    field.name = names[source.ConsumeIntegralInRange<std::size_t>(0, names.size() - 1)];
    field.offset = source.ConsumeBool() ? source.ConsumeIntegralInRange<std::uint32_t>(0, 40)
                                        : source.ConsumeIntegral<std::uint32_t>();
    field.datatype = source.ConsumeIntegralInRange<std::uint8_t>(0, 9);
    field.count = source.ConsumeIntegralInRange<std::uint32_t>(0, 2);
    cloud.fields.push_back(field);
  }
  cloud.is_bigendian = source.ConsumeBool() ? 1 : 0;
  if (source.ConsumeBool()) {
    cloud.width = source.ConsumeIntegralInRange<std::uint32_t>(0, 64);
    cloud.height = source.ConsumeIntegralInRange<std::uint32_t>(0, 2);
    cloud.point_step = source.ConsumeIntegralInRange<std::uint32_t>(0, 48);
    cloud.row_step = cloud.width * cloud.point_step;
  } else {
    cloud.width = source.ConsumeIntegral<std::uint32_t>();
    cloud.height = source.ConsumeIntegral<std::uint32_t>();
    cloud.point_step = source.ConsumeIntegral<std::uint32_t>();
    cloud.row_step = source.ConsumeIntegral<std::uint32_t>();
  }
  cloud.data = AnyData(source);
}

/// A source of what is in a message, for a reader of that message.
template <typename Read>
Reader OfSource(Read read) {
  return [=](const std::string& bytes) {
    Source source(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    read(source);
  };
}

void DecodeClouds(Source& source) {
  PointCloudDecoder decoder{PointCloudDecoderConfig()};
  while (source.remaining_bytes() > 0) {
    sensor_msgs::PointCloud2 cloud;
    Fill(source, cloud);
    decoder.Decode(ViewOf(cloud));
  }
}

void ReadKeyframe(Source& source) {
  hv_msgs::Keyframe message;
  Fill(source, message.header);
  message.scan_start = AnyTime(source);
  message.id = source.ConsumeIntegral<std::uint32_t>();
  Fill(source, message.pose.pose);
  for (double& value : message.pose.covariance) value = source.ConsumeFloatingPoint<double>();
  FillVector(source, message.gravity);
  message.degenerate_translation.resize(source.ConsumeIntegralInRange<std::size_t>(0, 5));
  for (auto& direction : message.degenerate_translation) FillVector(source, direction);
  FillVector(source, message.sensor_origin);
  Fill(source, message.cloud);
  FromMessage(message);
}

void ReadTrackedScan(Source& source) {
  hv_msgs::TrackedScan message;
  Fill(source, message.header);
  Fill(source, message.pose);
  Fill(source, message.base_pose);
  FillVector(source, message.sensor_origin);
  Fill(source, message.cloud);
  FromMessage(message);
}

void ReadOccupancyGrid(Source& source) {
  nav_msgs::OccupancyGrid message;
  Fill(source, message.header);
  message.info.resolution = source.ConsumeFloatingPoint<float>();
  message.info.width = source.ConsumeIntegral<std::uint32_t>();
  message.info.height = source.ConsumeIntegralInRange<std::uint32_t>(0, 40);
  if (source.ConsumeBool()) message.info.width %= 40;
  Fill(source, message.info.origin);
  message.data = source.ConsumeBytes<std::int8_t>(kMostData);
  OccupancyGrid grid;
  ReadGrid(message, grid);
}

void ReadDepth(Source& source) {
  static const std::vector<std::string> encodings = {"16UC1", "mono16", "32FC1", "8UC1", ""};
  sensor_msgs::Image image;
  Fill(source, image.header);
  image.encoding = encodings[source.ConsumeIntegralInRange<std::size_t>(0, encodings.size() - 1)];
  image.is_bigendian = source.ConsumeBool() ? 1 : 0;
  image.width = source.ConsumeIntegral<std::uint32_t>();
  image.height = source.ConsumeIntegral<std::uint32_t>();
  image.step = source.ConsumeIntegral<std::uint32_t>();
  if (source.ConsumeBool()) {
    image.width %= 40;
    image.height %= 20;
    image.step %= 160;
  }
  sensor_msgs::CameraInfo camera;
  camera.width = source.ConsumeBool() ? image.width : source.ConsumeIntegral<std::uint32_t>();
  camera.height = source.ConsumeBool() ? image.height : source.ConsumeIntegral<std::uint32_t>();
  for (double& value : camera.K) value = source.ConsumeFloatingPoint<double>();
  for (double& value : camera.P) value = source.ConsumeFloatingPoint<double>();
  image.data = AnyData(source);
  navigation::FromMessages(image, camera);
}

}  // namespace

Readers MessageReaders() {
  return {
      {"message_depth", OfSource(ReadDepth)},
      {"message_grid", OfSource(ReadOccupancyGrid)},
      {"message_keyframe", OfSource(ReadKeyframe)},
      {"message_points", OfSource(DecodeClouds)},
      {"message_tracked_scan", OfSource(ReadTrackedScan)},
  };
}

}  // namespace hv::fuzz
