#include "nclt_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iomanip>

#include "hv_core/error.h"

namespace hv::sim {
namespace {

constexpr int kColumnsPerPacket = 12;
constexpr std::uint16_t kMagic = 44444;
constexpr double kScale = 0.005;    ///< [m]
constexpr double kOffset = -100.0;  ///< [m]
constexpr std::size_t kHitSize = 8;

/// The earth's field at Ann Arbor, world frame (x north, z up) [gauss].
const Eigen::Vector3d kMagneticField(0.18, 0.0, -0.51);

using Hits = std::vector<std::array<char, kHitSize>>;

std::int64_t ToMicroseconds(Time time) {
  return (time.nanoseconds() + (time.nanoseconds() >= 0 ? 500 : -500)) / 1000;
}

std::uint16_t Encode(float metres) {
  const double value = std::round((static_cast<double>(metres) - kOffset) / kScale);
  return static_cast<std::uint16_t>(std::clamp(value, 0.0, 65535.0));
}

std::array<char, kHitSize> EncodeHit(const Point& point) {
  const std::array<std::uint16_t, 3> xyz{Encode(point.x), Encode(point.y), Encode(point.z)};
  const std::array<std::uint8_t, 2> rest{
      static_cast<std::uint8_t>(std::clamp(point.intensity, 0.0F, 255.0F)),
      static_cast<std::uint8_t>(point.ring)};
  std::array<char, kHitSize> hit{};
  std::memcpy(hit.data(), xyz.data(), sizeof(xyz));
  std::memcpy(hit.data() + sizeof(xyz), rest.data(), sizeof(rest));
  return hit;
}

void WriteAll(std::ofstream& file, const Hits& hits) {
  for (const auto& hit : hits) file.write(hit.data(), hit.size());
}

void WritePacket(std::ofstream& file, Time stamp, const Hits& hits) {
  const std::array<std::uint16_t, 4> magic{kMagic, kMagic, kMagic, kMagic};
  const auto count = static_cast<std::uint32_t>(hits.size());
  const auto utime = static_cast<std::uint64_t>(ToMicroseconds(stamp));
  std::array<char, 24> header{};
  std::memcpy(header.data(), magic.data(), sizeof(magic));
  std::memcpy(header.data() + 8, &count, sizeof(count));
  std::memcpy(header.data() + 12, &utime, sizeof(utime));
  file.write(header.data(), header.size());
  WriteAll(file, hits);
}

/// NaN cannot be written in this format; such hits are left out.
bool Writable(const Point& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

void Open(std::ofstream& file, const std::string& path, std::ios::openmode mode) {
  file.open(path, mode | std::ios::out | std::ios::trunc);
  if (!file) throw InputError(path + ": cannot be written");
}

void Close(std::ofstream& file, const std::string& path) {
  file.close();
  if (!file) throw InputError(path + ": cannot be written");
}

void PutVector(std::ostream& out, const Eigen::Vector3d& v) {
  out << ',' << v.x() << ',' << v.y() << ',' << v.z();
}

}  // namespace

NcltWriter::NcltWriter(const Recording& recording, const std::string& directory)
    : recording_(recording), directory_(directory + "/") {
  std::error_code error;
  std::filesystem::create_directories(directory_ + "velodyne_sync", error);
  if (error) throw InputError(directory_ + "velodyne_sync: " + error.message());
  Open(hits_, directory_ + "velodyne_hits.bin", std::ios::binary);
  Open(imu_, directory_ + "ms25.csv", {});
  imu_ << std::setprecision(9);
}

std::vector<std::string> NcltWriter::files() const {
  return {directory_ + "velodyne_hits.bin", directory_ + "velodyne_sync", directory_ + "ms25.csv",
          directory_ + "groundtruth_2012-01-10.csv"};
}

void NcltWriter::Write(const SensorMessage& message) {
  if (const Scan* scan = std::get_if<Scan>(&message.data)) {
    WriteHits(*scan);
    WriteSync(message.header_stamp, *scan);
  } else {
    WriteImu(message, std::get<ImuSample>(message.data));
  }
}

void NcltWriter::Finish() {
  Close(hits_, directory_ + "velodyne_hits.bin");
  Close(imu_, directory_ + "ms25.csv");
  WriteGroundTruth();
}

void NcltWriter::WriteHits(const Scan& scan) {
  const double packet_period = kColumnsPerPacket * recording_.lidar().model().column_period;
  Hits hits;
  int packet = 0;
  const auto flush = [&] {
    if (!hits.empty()) WritePacket(hits_, scan.stamp + packet * packet_period, hits);
    hits.clear();
  };
  for (const Point& point : scan.points) {
    if (!Writable(point)) continue;
    const auto own_packet = static_cast<int>(std::floor(point.time / packet_period + 1e-6));
    if (own_packet != packet) flush();
    packet = own_packet;
    hits.push_back(EncodeHit(point));
  }
  flush();
}

void NcltWriter::WriteSync(Time stamp, const Scan& scan) const {
  const std::string path =
      directory_ + "velodyne_sync/" + std::to_string(ToMicroseconds(stamp)) + ".bin";
  std::ofstream file;
  Open(file, path, std::ios::binary);
  Hits hits;
  for (const Point& point : scan.points) {
    if (Writable(point)) hits.push_back(EncodeHit(point));
  }
  WriteAll(file, hits);
  Close(file, path);
}

void NcltWriter::WriteImu(const SensorMessage& message, const ImuSample& sample) {
  const Time epoch = Time::FromSeconds(recording_.config().suite.epoch_s);
  const Pose T_world_imu =
      recording_.BodyAt(message.arrival - epoch).T_world_body * recording_.rig().T_body_imu();
  const Eigen::Vector3d field = T_world_imu.linear().transpose() * kMagneticField;
  imu_ << ToMicroseconds(message.header_stamp);
  PutVector(imu_, field);
  PutVector(imu_, sample.acceleration);
  PutVector(imu_, sample.angular_velocity);
  imu_ << '\n';
}

void NcltWriter::WriteGroundTruth() const {
  const std::string path = directory_ + "groundtruth_2012-01-10.csv";
  std::ofstream file;
  Open(file, path, {});
  file << std::setprecision(12);
  const Pose T_down_world = MakePose(RotationFromRpy(M_PI, 0.0, 0.0), Eigen::Vector3d::Zero());
  const Trajectory truth = recording_.BaseTruth();
  for (const StampedPose& stamped : truth.poses()) {
    const Pose T_down_body = T_down_world * stamped.pose;
    const Eigen::Matrix3d R = T_down_body.linear();
    const Eigen::Vector3d rpy(std::atan2(R(2, 1), R(2, 2)), -std::asin(R(2, 0)),
                              std::atan2(R(1, 0), R(0, 0)));
    file << ToMicroseconds(stamped.stamp);
    PutVector(file, T_down_body.translation());
    PutVector(file, rpy);
    file << '\n';
  }
  Close(file, path);
}

}  // namespace hv::sim
