#include "hv_replay/nclt_to_bag.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <rosbag/bag.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>

#include "hv_core/error.h"
#include "hv_core/trajectory.h"
#include "hv_replay/console.h"
#include "hv_replay/nclt.h"

namespace hv::replay {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kPointStep = 24;

ros::Time ToRos(Time time) {
  return ros::Time().fromNSec(
      static_cast<std::uint64_t>(std::max<std::int64_t>(time.nanoseconds(), 0)));
}

sensor_msgs::PointField Field(const char* name, std::uint32_t offset, std::uint8_t type) {
  sensor_msgs::PointField field;
  field.name = name;
  field.offset = offset;
  field.datatype = type;
  field.count = 1;
  return field;
}

sensor_msgs::PointCloud2 ToMessage(const Scan& scan) {
  using sensor_msgs::PointField;
  sensor_msgs::PointCloud2 cloud;
  cloud.header.stamp = ToRos(scan.stamp);
  cloud.header.frame_id = "velodyne";
  cloud.fields = {
      Field("x", 0, PointField::FLOAT32),     Field("y", 4, PointField::FLOAT32),
      Field("z", 8, PointField::FLOAT32),     Field("intensity", 12, PointField::FLOAT32),
      Field("time", 16, PointField::FLOAT32), Field("ring", 20, PointField::UINT16)};
  cloud.width = static_cast<std::uint32_t>(scan.points.size());
  cloud.height = 1;
  cloud.point_step = kPointStep;
  cloud.row_step = kPointStep * cloud.width;
  cloud.is_dense = true;
  cloud.data.resize(cloud.row_step);
  std::uint8_t* bytes = cloud.data.data();
  for (const Point& point : scan.points) {
    const float values[5] = {point.x, point.y, point.z, point.intensity, point.time};
    std::memcpy(bytes, values, sizeof(values));
    std::memcpy(bytes + 20, &point.ring, sizeof(point.ring));
    bytes += kPointStep;
  }
  return cloud;
}

sensor_msgs::Imu ToMessage(const ImuSample& sample) {
  sensor_msgs::Imu imu;
  imu.header.stamp = ToRos(sample.stamp);
  imu.header.frame_id = "imu_link";
  imu.orientation.w = 1.0;
  imu.orientation_covariance[0] = -1.0;
  imu.angular_velocity.x = sample.angular_velocity.x();
  imu.angular_velocity.y = sample.angular_velocity.y();
  imu.angular_velocity.z = sample.angular_velocity.z();
  imu.linear_acceleration.x = sample.acceleration.x();
  imu.linear_acceleration.y = sample.acceleration.y();
  imu.linear_acceleration.z = sample.acceleration.z();
  return imu;
}

/// Writes sweeps and, before each, the IMU samples up to its end.
class Writer {
 public:
  Writer(rosbag::Bag& bag, std::vector<ImuSample> imu) : bag_(bag), imu_(std::move(imu)) {}

  void Write(Scan sweep) {
    if (!shift_) shift_ = nclt::VerticalShift(sweep.points);
    nclt::ToVelodyneFrame(shift_.value_or(0.0), sweep.points);
    WriteImuUntil(sweep.end());
    bag_.write("/points", ToRos(sweep.end()), ToMessage(sweep));
    if (sweeps_ == 0) begin_ = sweep.stamp;
    end_ = sweep.end();
    ++sweeps_;
  }

  void WriteImuUntil(Time stamp) {
    for (; next_imu_ < imu_.size() && imu_[next_imu_].stamp <= stamp; ++next_imu_) {
      bag_.write("/imu_raw", ToRos(imu_[next_imu_].stamp), ToMessage(imu_[next_imu_]));
    }
  }

  void WriteRemainingImu() {
    if (!imu_.empty()) WriteImuUntil(imu_.back().stamp);
  }

  std::size_t sweeps() const { return sweeps_; }
  double duration() const { return sweeps_ > 0 ? end_ - begin_ : 0.0; }

 private:
  rosbag::Bag& bag_;
  std::vector<ImuSample> imu_;
  std::size_t next_imu_ = 0;
  std::size_t sweeps_ = 0;
  std::optional<double> shift_;
  Time begin_, end_;
};

void ConvertHits(const std::string& path, Writer& writer, NcltConversion& conversion) {
  nclt::HitsReader reader(path);
  nclt::SweepBuilder builder;
  ProgressLine progress("hv_nclt_to_bag");
  while (std::optional<nclt::Packet> packet = reader.Next()) {
    if (std::optional<Scan> sweep = builder.Add(*packet)) writer.Write(std::move(*sweep));
    progress.Update(reader.fraction(), std::to_string(writer.sweeps()) + " sweeps");
  }
  if (std::optional<Scan> sweep = builder.Finish()) writer.Write(std::move(*sweep));
  if (reader.truncated()) conversion.problems.push_back(path + ": ends inside a packet");
  if (reader.skipped_bytes() > 0) {
    conversion.problems.push_back(path + ": " + std::to_string(reader.skipped_bytes()) +
                                  " bytes that are no packet were skipped");
  }
}

/// Reads `<utime>.bin`; nullopt when the name is not a time.
std::optional<nclt::Packet> ReadSync(const fs::path& path) {
  std::int64_t microseconds = 0;
  const std::string stem = path.stem().string();
  if (stem.empty() || stem.size() > 16 ||
      !std::all_of(stem.begin(), stem.end(),
                   [](unsigned char c) { return std::isdigit(c) != 0; })) {
    return std::nullopt;
  }
  microseconds = std::stoll(stem);
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  return nclt::Packet{Time::FromNanoseconds(microseconds * 1000),
                      nclt::DecodeHits(data, bytes.size())};
}

void ConvertSync(const fs::path& folder, Writer& writer, NcltConversion& conversion) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".bin") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  ProgressLine progress("hv_nclt_to_bag");
  for (std::size_t i = 0; i < files.size(); ++i) {
    const bool whole = fs::file_size(files[i]) % 8 == 0;
    if (!whole) conversion.problems.push_back(files[i].string() + ": ends inside a hit");
    if (std::optional<nclt::Packet> file = ReadSync(files[i])) {
      writer.Write(nclt::SweepFromSync(std::move(*file)));
    }
    progress.Update(static_cast<double>(i + 1) / static_cast<double>(files.size()),
                    std::to_string(writer.sweeps()) + " sweeps");
  }
}

void ConvertSweeps(const fs::path& input, Writer& writer, NcltConversion& conversion) {
  if (fs::exists(input / "velodyne_hits.bin")) {
    ConvertHits((input / "velodyne_hits.bin").string(), writer, conversion);
  } else if (fs::is_directory(input / "velodyne_sync")) {
    ConvertSync(input / "velodyne_sync", writer, conversion);
  } else {
    throw InputError(input.string() + ": holds neither velodyne_hits.bin nor velodyne_sync/");
  }
  if (writer.sweeps() == 0) throw InputError(input.string() + ": no LiDAR sweep found");
}

void ConvertGroundTruth(const fs::path& input, const fs::path& bag_path,
                        NcltConversion& conversion) {
  for (const fs::directory_entry& entry : fs::directory_iterator(input)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("groundtruth_", 0) != 0 || entry.path().extension() != ".csv") continue;
    const Trajectory truth = nclt::ReadGroundTruth(entry.path().string());
    conversion.truth_poses = truth.size();
    conversion.truth_path = fs::path(bag_path).replace_extension(".tum").string();
    WriteTum(conversion.truth_path, truth);
    return;
  }
}

}  // namespace

NcltConversion ConvertNclt(const std::string& input, const std::string& bag_path) {
  if (!fs::is_directory(input)) throw InputError(input + ": not a folder");
  NcltConversion conversion;
  bool truncated = false;
  const std::string imu_path = (fs::path(input) / "ms25.csv").string();
  std::vector<ImuSample> imu = nclt::ReadMs25(imu_path, truncated);
  if (imu.empty()) throw InputError(imu_path + ": no IMU samples");
  if (truncated) conversion.problems.push_back(imu_path + ": ends inside a line");
  conversion.imu_samples = imu.size();

  const std::string part = bag_path + ".part";
  try {
    rosbag::Bag bag(part, rosbag::bagmode::Write);
    bag.setCompression(rosbag::compression::LZ4);
    Writer writer(bag, std::move(imu));
    ConvertSweeps(input, writer, conversion);
    writer.WriteRemainingImu();
    conversion.sweeps = writer.sweeps();
    conversion.duration_s = writer.duration();
    bag.close();
    fs::rename(part, bag_path);
  } catch (const rosbag::BagException& error) {
    throw InputError(bag_path + ": cannot be written: " + error.what());
  } catch (const InputError&) {
    fs::remove(part);
    throw;
  }
  ConvertGroundTruth(input, bag_path, conversion);
  return conversion;
}

}  // namespace hv::replay
