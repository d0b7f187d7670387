#include "hv_core/point_cloud_decoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "point_time.h"

namespace hv {
namespace {

/// Clouds whose times cannot be judged before azimuth is used for good.
constexpr int kMaxUnjudgedClouds = 10;

constexpr std::size_t SizeOf(FieldType type) {
  switch (type) {
    case FieldType::kInt8:
    case FieldType::kUint8:
      return 1;
    case FieldType::kInt16:
    case FieldType::kUint16:
      return 2;
    case FieldType::kInt32:
    case FieldType::kUint32:
    case FieldType::kFloat32:
      return 4;
    case FieldType::kFloat64:
      return 8;
  }
  return 0;
}

/// Calls `use` with a value-initialised number of the field's C++ type.
template <typename Use>
void WithType(FieldType type, Use&& use) {
  switch (type) {
    case FieldType::kInt8:
      return use(std::int8_t{});
    case FieldType::kUint8:
      return use(std::uint8_t{});
    case FieldType::kInt16:
      return use(std::int16_t{});
    case FieldType::kUint16:
      return use(std::uint16_t{});
    case FieldType::kInt32:
      return use(std::int32_t{});
    case FieldType::kUint32:
      return use(std::uint32_t{});
    case FieldType::kFloat32:
      return use(float{});
    case FieldType::kFloat64:
      return use(double{});
  }
}

template <typename T>
T Load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

const PointFieldView* FindField(const PointCloudView& cloud, const std::string& name) {
  for (const PointFieldView& field : cloud.fields) {
    const std::size_t size = SizeOf(field.type);
    const bool inside =
        size > 0 && field.offset <= cloud.point_step && size <= cloud.point_step - field.offset;
    if (field.name == name && inside) return &field;
  }
  return nullptr;
}

const PointFieldView* FindAnyField(const PointCloudView& cloud,
                                   std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (const PointFieldView* field = FindField(cloud, name)) return field;
  }
  return nullptr;
}

std::string FieldNames(const PointCloudView& cloud) {
  std::string names;
  for (const PointFieldView& field : cloud.fields) {
    names += (names.empty() ? "" : ", ") + field.name;
  }
  return names.empty() ? "none" : names;
}

/// Empty when every point of `cloud` lies inside its data.
std::string CheckSizes(const PointCloudView& cloud) {
  if (cloud.is_bigendian) return "big-endian point clouds are not supported";
  if (cloud.width == 0 || cloud.height == 0) return "";
  if (cloud.point_step == 0) return "point_step is 0";
  const std::uint64_t line = std::uint64_t{cloud.width} * cloud.point_step;
  const std::uint64_t rows_before_last = cloud.height - 1;
  const bool rows_overlap = rows_before_last > 0 && cloud.row_step < line;
  const bool too_short =
      cloud.data == nullptr || line > cloud.size ||
      (rows_before_last > 0 && cloud.row_step > (cloud.size - line) / rows_before_last);
  if (!rows_overlap && !too_short) return "";
  return "data of " + std::to_string(cloud.size) + " bytes does not hold " +
         std::to_string(cloud.width) + " x " + std::to_string(cloud.height) + " points of " +
         std::to_string(cloud.point_step) + " bytes (row_step " + std::to_string(cloud.row_step) +
         ")";
}

struct Coordinates {
  const PointFieldView* x = nullptr;
  const PointFieldView* y = nullptr;
  const PointFieldView* z = nullptr;
};

/// Empty when the cloud has usable coordinates.
std::string FindCoordinates(const PointCloudView& cloud, Coordinates& xyz) {
  xyz = {FindField(cloud, "x"), FindField(cloud, "y"), FindField(cloud, "z")};
  if (xyz.x == nullptr || xyz.y == nullptr || xyz.z == nullptr) {
    return "no usable fields x, y, z (fields: " + FieldNames(cloud) + ")";
  }
  const bool floating = xyz.x->type == FieldType::kFloat32 || xyz.x->type == FieldType::kFloat64;
  if (!floating || xyz.y->type != xyz.x->type || xyz.z->type != xyz.x->type) {
    return "fields x, y, z must all be float32 or all be float64";
  }
  return "";
}

/// Copies one field of each kept point through `store(index, value)`.
template <typename Store>
void ForEachValue(const PointFieldView& field, const std::vector<const std::uint8_t*>& kept,
                  Store&& store) {
  WithType(field.type, [&](auto tag) {
    using T = decltype(tag);
    for (std::size_t i = 0; i < kept.size(); ++i) store(i, Load<T>(kept[i] + field.offset));
  });
}

template <typename T>
std::uint16_t ToRing(T value) {
  constexpr std::uint16_t kMax = std::numeric_limits<std::uint16_t>::max();
  if (!(value > T{0})) return 0;
  if (static_cast<double>(value) >= static_cast<double>(kMax)) return kMax;
  return static_cast<std::uint16_t>(value);
}

/// True for a share of 1/stride of all indices, spread evenly in every arithmetic progression of
/// common channel counts (multiples of the golden ratio modulo 1).
bool InGoldenPattern(std::size_t index, int stride) {
  const std::uint32_t phase = static_cast<std::uint32_t>(index) * 2654435769U;
  return phase < std::numeric_limits<std::uint32_t>::max() / static_cast<std::uint32_t>(stride);
}

}  // namespace

void PointCloudDecoderConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("min_range_m", min_range_m, "nearer points are dropped [m]");
  visitor.Field("max_range_m", max_range_m, "farther points are dropped [m]");
  visitor.Field("point_stride", point_stride, "keep every n-th return of each ring; 1 keeps all");
  visitor.Field("time_field", time_field,
                "field with the time of each point: auto, none (clouds are already deskewed) or "
                "its name");
  visitor.Field("time_unit", time_unit, "unit of that field: auto, s, ms, us, ns");
  visitor.Field("header_stamp", header_stamp,
                "header stamp is the time of the first point (begin) or the last (end), or auto");
  visitor.Field("scan_period_s", scan_period_s,
                "duration of a sweep [s]; 0: clouds are already deskewed");
}

void PointCloudDecoderConfig::Validate(ConfigProblems& problems) const {
  problems.Require(min_range_m >= 0.0, "min_range_m", "must be at least 0");
  problems.Require(max_range_m > min_range_m, "max_range_m", "must be above min_range_m");
  problems.Require(point_stride >= 1, "point_stride", "must be at least 1");
  problems.Require(!time_field.empty(), "time_field", "must be auto, none or the name of a field");
  const std::array<const char*, 5> units = {"auto", "s", "ms", "us", "ns"};
  problems.Require(std::find(units.begin(), units.end(), time_unit) != units.end(), "time_unit",
                   "must be auto, s, ms, us or ns");
  problems.Require(header_stamp == "auto" || header_stamp == "begin" || header_stamp == "end",
                   "header_stamp", "must be auto, begin or end");
  problems.Require(scan_period_s >= 0.0 && scan_period_s <= 10.0, "scan_period_s",
                   "must be between 0 and 10");
}

/// Buffers kept from cloud to cloud, and the steps of decoding that need no decision.
struct PointCloudDecoder::Workspace {
  std::vector<const std::uint8_t*> kept;  ///< first byte of each point of the scan
  PointTimes times;

  template <typename T>
  void SelectByRange(const PointCloudView& cloud, const Coordinates& xyz,
                     const PointCloudDecoderConfig& config, DecodedScan& result);
  void ReadRings(const PointCloudView& cloud, std::vector<Point>& points) const;
  void Thin(bool has_ring, int stride, std::vector<Point>& points);
  void ReadIntensities(const PointCloudView& cloud, std::vector<Point>& points) const;
  void ReadTimes(const PointFieldView& field);
  ResolvedTimes RebuildTimes(const Scan& scan, Time header, const PointTimeLayout& layout,
                             double scan_period_s) const;
};

template <typename T>
void PointCloudDecoder::Workspace::SelectByRange(const PointCloudView& cloud,
                                                 const Coordinates& xyz,
                                                 const PointCloudDecoderConfig& config,
                                                 DecodedScan& result) {
  const T min_squared = static_cast<T>(config.min_range_m * config.min_range_m);
  const T max_squared = static_cast<T>(config.max_range_m * config.max_range_m);
  std::vector<Point>& points = result.scan.points;
  points.resize(result.points_in);
  kept.resize(result.points_in);
  std::size_t count = 0;
  for (std::uint32_t row = 0; row < cloud.height; ++row) {
    const std::uint8_t* bytes = cloud.data + std::size_t{row} * cloud.row_step;
    for (std::uint32_t column = 0; column < cloud.width; ++column, bytes += cloud.point_step) {
      const T x = Load<T>(bytes + xyz.x->offset);
      const T y = Load<T>(bytes + xyz.y->offset);
      const T z = Load<T>(bytes + xyz.z->offset);
      const T squared = x * x + y * y + z * z;
      if (squared >= min_squared && squared <= max_squared) {
        kept[count] = bytes;
        Point& point = points[count++];
        point.x = static_cast<float>(x);
        point.y = static_cast<float>(y);
        point.z = static_cast<float>(z);
      } else if (std::isfinite(x) && std::isfinite(y) && std::isfinite(z)) {
        ++result.out_of_range;
      } else {
        ++result.not_finite;
      }
    }
  }
  points.resize(count);
  kept.resize(count);
}

void PointCloudDecoder::Workspace::ReadRings(const PointCloudView& cloud,
                                             std::vector<Point>& points) const {
  const PointFieldView* field = FindAnyField(cloud, {"ring", "channel", "line"});
  if (field == nullptr) return;
  ForEachValue(*field, kept,
               [&points](std::size_t i, auto value) { points[i].ring = ToRing(value); });
}

void PointCloudDecoder::Workspace::Thin(bool has_ring, int stride, std::vector<Point>& points) {
  std::array<int, 256> countdown;
  for (std::size_t ring = 0; ring < countdown.size(); ++ring) {
    countdown[ring] = static_cast<int>(ring % static_cast<std::size_t>(stride));
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    int& left = countdown[points[i].ring % countdown.size()];
    const bool keep = has_ring ? left == 0 : InGoldenPattern(i, stride);
    left = left == 0 ? stride - 1 : left - 1;
    if (!keep) continue;
    points[count] = points[i];
    kept[count++] = kept[i];
  }
  points.resize(count);
  kept.resize(count);
}

void PointCloudDecoder::Workspace::ReadIntensities(const PointCloudView& cloud,
                                                   std::vector<Point>& points) const {
  const PointFieldView* field = FindAnyField(cloud, {"intensity", "reflectivity", "i"});
  if (field == nullptr) return;
  ForEachValue(*field, kept, [&points](std::size_t i, auto value) {
    const float intensity = static_cast<float>(value);
    points[i].intensity = std::isfinite(intensity) ? intensity : 0.0F;
  });
}

void PointCloudDecoder::Workspace::ReadTimes(const PointFieldView& field) {
  times.base = 0.0L;
  times.offset.resize(kept.size());
  WithType(field.type, [&](auto tag) {
    using T = decltype(tag);
    using Difference = std::conditional_t<std::is_integral_v<T>, std::int64_t, double>;
    Difference base = 0;
    for (const std::uint8_t* point : kept) {
      const T value = Load<T>(point + field.offset);
      base = static_cast<Difference>(value);
      if (std::is_integral_v<T> || std::isfinite(static_cast<double>(value))) break;
      base = 0;
    }
    times.base = static_cast<long double>(base);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const Difference value = static_cast<Difference>(Load<T>(kept[i] + field.offset));
      times.offset[i] = static_cast<double>(value - base);
    }
  });
}

ResolvedTimes PointCloudDecoder::Workspace::RebuildTimes(const Scan& scan, Time header,
                                                         const PointTimeLayout& layout,
                                                         double scan_period_s) const {
  std::vector<float> azimuth;
  azimuth.reserve(scan.points.size());
  for (const Point& point : scan.points) azimuth.push_back(std::atan2(point.y, point.x));
  return TimesFromAzimuth(azimuth, header, layout, scan_period_s);
}

PointCloudDecoder::PointCloudDecoder(const PointCloudDecoderConfig& config)
    : config_(config), workspace_(std::make_unique<Workspace>()) {
  ConfigProblems problems;
  config.Validate(problems);
  if (!problems.lines().empty()) throw InputError("point cloud decoder: " + problems.lines()[0]);
  if (config_.time_field == "none" || config_.scan_period_s == 0.0) {
    layout_.emplace();
    layout_->deskewed = true;
  }
}

PointCloudDecoder::~PointCloudDecoder() = default;
PointCloudDecoder::PointCloudDecoder(PointCloudDecoder&&) noexcept = default;
PointCloudDecoder& PointCloudDecoder::operator=(PointCloudDecoder&&) noexcept = default;

DecodedScan PointCloudDecoder::Decode(const PointCloudView& cloud) {
  DecodedScan result;
  result.scan.stamp = cloud.stamp;
  result.error = CheckSizes(cloud);
  if (!result.error.empty()) return result;
  result.points_in = std::size_t{cloud.width} * cloud.height;
  if (result.points_in == 0) return result;
  Coordinates xyz;
  result.error = FindCoordinates(cloud, xyz);
  if (!result.error.empty()) return result;

  std::vector<Point>& points = result.scan.points;
  if (xyz.x->type == FieldType::kFloat32) {
    workspace_->SelectByRange<float>(cloud, xyz, config_, result);
  } else {
    workspace_->SelectByRange<double>(cloud, xyz, config_, result);
  }
  workspace_->ReadRings(cloud, points);
  const bool has_ring = FindAnyField(cloud, {"ring", "channel", "line"}) != nullptr;
  if (config_.point_stride > 1) workspace_->Thin(has_ring, config_.point_stride, points);
  workspace_->ReadIntensities(cloud, points);
  if (!layout_) DecideTimeLayout(cloud);
  AssignTimes(cloud, result);
  return result;
}

void PointCloudDecoder::DecideTimeLayout(const PointCloudView& cloud) {
  const std::vector<std::string> configured = {config_.time_field};
  const bool search = config_.time_field == "auto";
  bool has_field = false;
  for (const std::string& name : search ? PointTimeFieldNames() : configured) {
    const PointFieldView* field = FindField(cloud, name);
    if (field == nullptr) continue;
    has_field = true;
    workspace_->ReadTimes(*field);
    layout_ = JudgePointTimes(workspace_->times, cloud.stamp, config_);
    if (!layout_) continue;
    layout_->field = name;
    return;
  }
  const bool give_up = search && !has_field && !workspace_->kept.empty();
  if (++unjudged_clouds_ < kMaxUnjudgedClouds && !give_up) return;
  layout_.emplace();
  layout_->from_azimuth = true;
  layout_->stamp_at_end = config_.header_stamp == "end";
}

void PointCloudDecoder::AssignTimes(const PointCloudView& cloud, DecodedScan& result) {
  if (layout_ && layout_->deskewed) return;
  Scan& scan = result.scan;
  ResolvedTimes resolved;
  if (!layout_ || layout_->from_azimuth) {
    PointTimeLayout fallback;
    fallback.stamp_at_end = config_.header_stamp == "end";
    resolved = workspace_->RebuildTimes(scan, cloud.stamp, fallback, config_.scan_period_s);
  } else if (const PointFieldView* field = FindField(cloud, layout_->field)) {
    workspace_->ReadTimes(*field);
    resolved = ResolvePointTimes(workspace_->times, cloud.stamp, *layout_, config_.scan_period_s);
  } else {
    result.error = "no time field '" + layout_->field + "' (fields: " + FieldNames(cloud) + ")";
    scan.points.clear();
    return;
  }
  scan.stamp = resolved.zero;
  std::size_t count = 0;
  float last = 0.0F;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (resolved.usable[i] == 0) continue;
    const float seconds = static_cast<float>(resolved.seconds[i]);
    last = std::max(last, seconds);
    if (count != i) scan.points[count] = scan.points[i];
    scan.points[count++].time = seconds;
  }
  scan.duration = static_cast<double>(last);
  result.bad_time = scan.points.size() - count;
  scan.points.resize(count);
}

}  // namespace hv
