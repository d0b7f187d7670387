#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hv_core/config.h"
#include "hv_core/scan.h"

namespace hv {

/// Datatype codes of sensor_msgs/PointField.
enum class FieldType : std::uint8_t {
  kInt8 = 1,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat32,
  kFloat64
};

struct PointFieldView {
  std::string name;
  std::uint32_t offset = 0;
  FieldType type = FieldType::kFloat32;
};

/// A packed point cloud as it travels in sensor_msgs/PointCloud2, without owning the bytes. Nothing
/// in it is trusted: the decoder checks every size.
struct PointCloudView {
  Time stamp;  ///< header stamp
  std::vector<PointFieldView> fields;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  bool is_bigendian = false;
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

struct PointCloudDecoderConfig {
  double min_range_m = 0.5;
  double max_range_m = 120.0;
  int point_stride = 1;
  std::string time_field = "auto";
  std::string time_unit = "auto";
  std::string header_stamp = "auto";
  double scan_period_s = 0.1;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// What was recognised about the time of each point, decided on the first clouds and then kept.
struct PointTimeLayout {
  std::string field;            ///< empty: no time field is used
  double unit_s = 1.0;          ///< seconds per count
  bool absolute = false;        ///< value is a time since the epoch, not near the header stamp
  bool negative = false;        ///< relative times count up to 0 at the end of the sweep
  bool stamp_at_end = false;    ///< header stamp is that of the last point
  bool other_clock = false;     ///< absolute, but of another clock than the header: header is used
  double clock_offset_s = 0.0;  ///< header minus first point, for absolute times [s]
  bool from_azimuth = false;    ///< times are rebuilt from azimuth and scan_period_s
  bool deskewed = false;        ///< all points are taken at the header stamp (scan_period_s = 0)

  /// One line for the log: "point time: field 'timestamp', absolute seconds, ...".
  std::string ToString() const;
};

/// Result of decoding one cloud. `error` is empty unless the cloud as a whole is unusable (no
/// xyz fields, sizes that contradict each other); then the scan has no points.
struct DecodedScan {
  Scan scan;
  std::size_t points_in = 0;
  std::size_t not_finite = 0;
  std::size_t out_of_range = 0;
  std::size_t bad_time = 0;  ///< time not finite or outside two scan periods
  std::string error;
};

/// Turns packed clouds of any common driver (Hesai, Velodyne, Ouster, Livox-style, RoboSense) into
/// scans. Finds the per-point time among `t`, `time`, `timestamp`, `offset_time`, `time_stamp`
/// and its unit from the span it covers. Points keep the order of the cloud. `point_stride` = n
/// keeps every n-th return of each ring, staggered from ring to ring; in clouds without a ring
/// field it keeps a share of 1/n by a pattern that resonates with no number of channels. Total on
/// any input: never throws after construction. Not thread-safe.
class PointCloudDecoder {
 public:
  /// Throws InputError when the configuration is invalid.
  explicit PointCloudDecoder(const PointCloudDecoderConfig& config);
  ~PointCloudDecoder();
  PointCloudDecoder(PointCloudDecoder&&) noexcept;
  PointCloudDecoder& operator=(PointCloudDecoder&&) noexcept;

  DecodedScan Decode(const PointCloudView& cloud);

  /// The decision about point times; nullopt until a cloud could be judged.
  const std::optional<PointTimeLayout>& time_layout() const { return layout_; }

 private:
  struct Workspace;

  void DecideTimeLayout(const PointCloudView& cloud);
  void AssignTimes(const PointCloudView& cloud, DecodedScan& result);

  PointCloudDecoderConfig config_;
  std::optional<PointTimeLayout> layout_;
  int unjudged_clouds_ = 0;
  std::unique_ptr<Workspace> workspace_;
};

/// View of a sensor_msgs::PointCloud2 (any type with its members), which must outlive the view.
template <typename PointCloud2>
PointCloudView ViewOf(const PointCloud2& message) {
  PointCloudView view;
  view.stamp = Time::FromNanoseconds(static_cast<std::int64_t>(message.header.stamp.toNSec()));
  for (const auto& field : message.fields) {
    view.fields.push_back({field.name, field.offset, static_cast<FieldType>(field.datatype)});
  }
  view.width = message.width;
  view.height = message.height;
  view.point_step = message.point_step;
  view.row_step = message.row_step;
  view.is_bigendian = message.is_bigendian != 0;
  view.data = message.data.data();
  view.size = message.data.size();
  return view;
}

}  // namespace hv
