#include "hv_replay/nclt.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include "hv_core/angles.h"
#include "hv_core/error.h"

namespace hv::replay::nclt {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kHitSize = 8;
constexpr std::size_t kHeaderSize = 24;
constexpr std::uint16_t kMagic = 44444;
/// A packet of the HDL-32E holds 12 firings of 32 lasers.
constexpr std::uint32_t kMaxHitsPerPacket = 4096;
constexpr int kFiringsPerPacket = 12;
constexpr double kFiringPeriod = 46.08e-6;
constexpr double kLaserPeriod = 1.152e-6;
constexpr double kSweepPeriod = 0.1;
constexpr int kLasers = 32;
/// Shift above which hits are taken as stored in the body frame [m].
constexpr double kBodyFrameShift = 0.3;

/// Turns z-down axes (x forward, y right) to z-up ones (x forward, y left) and back.
Eigen::Vector3d Flip(const Eigen::Vector3d& v) { return Eigen::Vector3d(v.x(), -v.y(), -v.z()); }

/// body_T_ms25 of the data set; its rotation is the identity.
Eigen::Vector3d MsInBody() { return Eigen::Vector3d(-0.11, -0.18, -0.71); }
Eigen::Vector3d VelodyneInBody() { return Eigen::Vector3d(0.002, -0.004, -0.957); }

/// Rotation of body_T_velodyne of the data set.
Eigen::Matrix3d VelodyneRotation() {
  return RotationFromRpy(0.807 * kRadiansPerDegree, 0.166 * kRadiansPerDegree,
                         -90.703 * kRadiansPerDegree);
}

/// Elevation of each laser about the sensor's own axis (user's manual of the HDL-32E) [rad].
double LaserElevation(int laser) {
  const double lowest = laser % 2 == 0 ? -92.0 / 3.0 : -28.0 / 3.0;
  return (lowest + 4.0 / 3.0 * (laser / 2)) * kRadiansPerDegree;
}

template <typename T>
T Load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

bool IsMagic(const std::uint8_t* bytes) {
  for (std::size_t k = 0; k < 4; ++k) {
    if (Load<std::uint16_t>(bytes + 2 * k) != kMagic) return false;
  }
  return true;
}

/// Stamps of the data set are microseconds since the epoch; nullopt when not a plausible one.
std::optional<Time> FromMicroseconds(std::uint64_t microseconds) {
  if (microseconds > 9000000000000000ULL) return std::nullopt;
  return Time::FromNanoseconds(static_cast<std::int64_t>(microseconds) * 1000);
}

/// Azimuth of the middle of a packet's hits [rad].
double MeanAzimuth(const std::vector<Point>& hits) {
  double x = 0.0;
  double y = 0.0;
  for (const Point& hit : hits) {
    const double range = std::hypot(static_cast<double>(hit.x), static_cast<double>(hit.y));
    if (range < 0.1) continue;
    x += static_cast<double>(hit.x) / range;
    y += static_cast<double>(hit.y) / range;
  }
  return std::atan2(y, x);
}

double WrapAngle(double angle) { return std::remainder(angle, 2.0 * kPi); }

/// Splits a line of numbers separated by commas or blanks; false when something else is in it.
bool ParseNumbers(const std::string& line, std::vector<double>& numbers) {
  numbers.clear();
  const char* at = line.data();
  const char* end = at + line.size();
  while (at != end) {
    if (*at == ',' || *at == ' ' || *at == '\t' || *at == '\r') {
      ++at;
      continue;
    }
    double value = 0.0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc()) return false;
    numbers.push_back(value);
    at = next;
  }
  return true;
}

/// Whole microseconds at the start of a line, exact where a double would round.
std::optional<Time> ParseStamp(const std::string& line) {
  std::uint64_t microseconds = 0;
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == std::string::npos) return std::nullopt;
  const auto [next, error] =
      std::from_chars(line.data() + first, line.data() + line.size(), microseconds);
  if (error != std::errc()) return std::nullopt;
  return FromMicroseconds(microseconds);
}

struct CsvRow {
  int number = 0;
  Time stamp;
  std::vector<double> values;
};

/// Reads rows of `columns` numbers. `truncated` tells that the last line is incomplete.
std::vector<CsvRow> ReadCsv(const std::string& path, std::size_t columns, bool& truncated) {
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be opened");
  std::vector<CsvRow> rows;
  std::string line;
  truncated = false;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
    CsvRow row;
    const std::optional<Time> stamp = ParseStamp(line);
    const bool good = ParseNumbers(line, row.values) && row.values.size() == columns && stamp;
    if (!good) {
      truncated = file.eof();
      if (truncated) break;
      throw InputError(path + ":" + std::to_string(number) + ": expected " +
                       std::to_string(columns) + " numbers starting with microseconds");
    }
    row.number = number;
    row.stamp = *stamp;
    rows.push_back(std::move(row));
  }
  if (file.bad()) throw InputError(path + ": cannot be read");
  return rows;
}

}  // namespace

Pose T_imu_velodyne() {
  return MakePose(Eigen::Matrix3d(Eigen::Matrix3d::Identity()),
                  Flip(VelodyneInBody() - MsInBody()));
}

std::vector<Point> DecodeHits(const std::uint8_t* data, std::size_t size) {
  std::vector<Point> hits(size / kHitSize);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::uint8_t* bytes = data + i * kHitSize;
    const auto metres = [bytes](std::size_t offset) {
      return static_cast<float>(Load<std::uint16_t>(bytes + offset) * 0.005 - 100.0);
    };
    hits[i].x = metres(0);
    hits[i].y = metres(2);
    hits[i].z = metres(4);
    hits[i].intensity = static_cast<float>(bytes[6]);
    hits[i].ring = bytes[7];
  }
  return hits;
}

HitsReader::HitsReader(const std::string& path) : file_(path, std::ios::binary) {
  if (!file_) throw InputError(path + ": cannot be opened");
  file_.seekg(0, std::ios::end);
  const std::streamoff size = file_.tellg();
  file_.seekg(0);
  if (!file_ || size < 0) throw InputError(path + ": cannot be read");
  size_ = static_cast<std::size_t>(size);
}

double HitsReader::fraction() const {
  const std::streamoff at = const_cast<std::ifstream&>(file_).tellg();
  return at < 0 || size_ == 0 ? 1.0 : static_cast<double>(at) / static_cast<double>(size_);
}

bool HitsReader::FindHeader() {
  std::array<std::uint8_t, 8> window{};
  if (!file_.read(reinterpret_cast<char*>(window.data()), window.size())) {
    truncated_ = truncated_ || file_.gcount() > 0;
    return false;
  }
  while (!IsMagic(window.data())) {
    std::copy(window.begin() + 1, window.end(), window.begin());
    const int next = file_.get();
    if (next == std::ifstream::traits_type::eof()) return false;
    window.back() = static_cast<std::uint8_t>(next);
    ++skipped_bytes_;
  }
  return true;
}

std::optional<Packet> HitsReader::Next() {
  while (FindHeader()) {
    std::array<std::uint8_t, kHeaderSize - 8> header{};
    if (!file_.read(reinterpret_cast<char*>(header.data()), header.size())) {
      truncated_ = true;
      return std::nullopt;
    }
    const std::uint32_t count = Load<std::uint32_t>(header.data());
    const std::optional<Time> stamp = FromMicroseconds(Load<std::uint64_t>(header.data() + 4));
    if (count > kMaxHitsPerPacket || !stamp) {
      skipped_bytes_ += kHeaderSize;
      continue;
    }
    std::vector<std::uint8_t> bytes(count * kHitSize);
    const auto size = static_cast<std::streamsize>(bytes.size());
    if (!file_.read(reinterpret_cast<char*>(bytes.data()), size)) {
      truncated_ = true;
      return std::nullopt;
    }
    return Packet{*stamp, DecodeHits(bytes.data(), bytes.size())};
  }
  return std::nullopt;
}

std::optional<double> VerticalShift(const std::vector<Point>& hits) {
  std::vector<double> shifts;
  for (const Point& hit : hits) {
    const double range = std::hypot(static_cast<double>(hit.x), static_cast<double>(hit.y));
    if (hit.ring >= kLasers || range < 2.0) continue;
    shifts.push_back(range * std::tan(LaserElevation(hit.ring)) - static_cast<double>(hit.z));
  }
  if (shifts.size() < 500) return std::nullopt;
  const auto middle = shifts.begin() + static_cast<std::ptrdiff_t>(shifts.size() / 2);
  std::nth_element(shifts.begin(), middle, shifts.end());
  return *middle;
}

void ToVelodyneFrame(double vertical_shift, std::vector<Point>& hits) {
  const bool in_body_frame = std::abs(vertical_shift) > kBodyFrameShift;
  const Eigen::Matrix3d rotation =
      in_body_frame ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : VelodyneRotation();
  const Eigen::Vector3d shift(0.0, 0.0, in_body_frame ? vertical_shift : 0.0);
  for (Point& hit : hits) {
    const Eigen::Vector3d stored = Eigen::Vector3f(hit.x, hit.y, hit.z).cast<double>();
    const Eigen::Vector3f turned = Flip(rotation * (stored + shift)).cast<float>();
    hit.x = turned.x();
    hit.y = turned.y();
    hit.z = turned.z();
  }
}

bool SweepBuilder::StartsNewSweep(const Packet& packet, double azimuth) const {
  if (sweep_.points.empty()) return false;
  const double age = packet.stamp - sweep_.stamp;
  const double silence = packet.stamp - last_stamp_;
  const bool wrapped = std::abs(azimuth - last_azimuth_) > kPi;
  return silence < 0.0 || silence > kSweepPeriod || age > 1.5 * kSweepPeriod ||
         (wrapped && age > 0.5 * kSweepPeriod);
}

std::optional<Scan> SweepBuilder::Add(const Packet& packet) {
  if (packet.hits.empty()) return std::nullopt;
  const double azimuth = MeanAzimuth(packet.hits);
  std::optional<Scan> finished;
  if (StartsNewSweep(packet, azimuth)) finished = Finish();
  if (sweep_.points.empty()) sweep_.stamp = packet.stamp;
  last_azimuth_ = azimuth;
  last_stamp_ = packet.stamp;
  const double start = packet.stamp - sweep_.stamp;
  int firing = 0;
  int last_laser = -1;
  for (Point hit : packet.hits) {
    if (hit.ring <= last_laser) firing = std::min(firing + 1, kFiringsPerPacket - 1);
    last_laser = hit.ring;
    const double time = start + firing * kFiringPeriod + hit.ring % kLasers * kLaserPeriod;
    hit.time = static_cast<float>(time);
    sweep_.duration = std::max(sweep_.duration, time);
    sweep_.points.push_back(hit);
  }
  return finished;
}

std::optional<Scan> SweepBuilder::Finish() {
  if (sweep_.points.empty()) return std::nullopt;
  Scan finished = std::move(sweep_);
  sweep_ = Scan();
  return finished;
}

Scan SweepFromSync(Packet file) {
  Scan sweep;
  sweep.stamp = file.stamp;
  sweep.points = std::move(file.hits);
  double turned = 0.0;
  double last_azimuth = 0.0;
  std::vector<double> progress;
  for (const Point& point : sweep.points) {
    const double azimuth = std::atan2(static_cast<double>(point.y), static_cast<double>(point.x));
    if (!progress.empty()) turned += WrapAngle(azimuth - last_azimuth);
    last_azimuth = azimuth;
    progress.push_back(turned);
  }
  const double direction = turned < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const double turns = std::clamp(direction * progress[i] / (2.0 * kPi), 0.0, 1.0);
    sweep.points[i].time = static_cast<float>(turns * kSweepPeriod);
    sweep.duration = std::max(sweep.duration, turns * kSweepPeriod);
  }
  return sweep;
}

std::vector<ImuSample> ReadMs25(const std::string& path, bool& truncated) {
  std::vector<ImuSample> samples;
  for (const CsvRow& row : ReadCsv(path, 10, truncated)) {
    ImuSample sample;
    sample.stamp = row.stamp;
    sample.acceleration = Flip(Eigen::Vector3d(row.values[4], row.values[5], row.values[6]));
    sample.angular_velocity = Flip(Eigen::Vector3d(row.values[7], row.values[8], row.values[9]));
    samples.push_back(sample);
  }
  const auto earlier = [](const ImuSample& a, const ImuSample& b) { return a.stamp < b.stamp; };
  const auto same = [](const ImuSample& a, const ImuSample& b) { return a.stamp == b.stamp; };
  std::stable_sort(samples.begin(), samples.end(), earlier);
  samples.erase(std::unique(samples.begin(), samples.end(), same), samples.end());
  return samples;
}

Trajectory ReadGroundTruth(const std::string& path) {
  bool truncated = false;
  std::vector<StampedPose> poses;
  const Pose T_body_imu = MakePose(RotationFromRpy(kPi, 0.0, 0.0), MsInBody());
  const Pose T_up_down = MakePose(RotationFromRpy(kPi, 0.0, 0.0), Eigen::Vector3d::Zero());
  for (const CsvRow& row : ReadCsv(path, 7, truncated)) {
    const std::vector<double>& v = row.values;
    if (!std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); })) continue;
    const Pose T_down_body =
        MakePose(RotationFromRpy(v[4], v[5], v[6]), Eigen::Vector3d(v[1], v[2], v[3]));
    poses.push_back({row.stamp, T_up_down * T_down_body * T_body_imu});
  }
  return Trajectory(std::move(poses));
}

}  // namespace hv::replay::nclt
