#include "hv_replay/kitti_to_bag.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include <rosbag/bag.h>
#include <sensor_msgs/PointCloud2.h>

#include "hv_core/error.h"
#include "hv_core/trajectory.h"
#include "hv_replay/console.h"
#include "hv_replay/kitti.h"

namespace hv::replay {
namespace {

namespace fs = std::filesystem;

/// 2011-09-26 12:00 UTC: bags cannot hold stamps at zero, where KITTI's times begin.
constexpr std::int64_t kEpochNs = 1317038400LL * 1000000000LL;
constexpr double kPeriodS = 0.1;
constexpr std::uint32_t kKittiPointStep = 16;

/// One sequence: its scan files in order, with their stamps.
struct Sequence {
  std::vector<fs::path> scans;
  std::vector<Time> stamps;
};

Time StampOf(double seconds) { return Time::FromNanoseconds(kEpochNs) + seconds; }

std::vector<Time> Stamps(const fs::path& times_path, std::size_t scans) {
  std::vector<Time> stamps;
  if (fs::exists(times_path)) {
    for (const double time : kitti::ReadTimes(times_path.string())) stamps.push_back(StampOf(time));
    if (stamps.size() < scans) {
      throw InputError(times_path.string() + ": " + std::to_string(stamps.size()) + " times for " +
                       std::to_string(scans) + " scans");
    }
  } else {
    for (std::size_t i = 0; i < scans; ++i) stamps.push_back(StampOf(kPeriodS * double(i)));
  }
  stamps.resize(scans);
  return stamps;
}

Sequence FindSequence(const fs::path& input) {
  const fs::path folder = input / "velodyne";
  if (!fs::is_directory(folder)) throw InputError(input.string() + ": holds no folder velodyne/");
  Sequence sequence;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".bin") sequence.scans.push_back(entry.path());
  }
  if (sequence.scans.empty()) throw InputError(folder.string() + ": holds no scans (*.bin)");
  std::sort(sequence.scans.begin(), sequence.scans.end());
  sequence.stamps = Stamps(input / "times.txt", sequence.scans.size());
  return sequence;
}

/// Poses of the LiDAR in its first frame; empty without poses.txt.
Trajectory ReadTruth(const fs::path& input, const Sequence& sequence) {
  const fs::path path = input / "poses.txt";
  if (!fs::exists(path)) return Trajectory();
  const std::vector<Pose> poses = kitti::ReadPoses(path.string());
  if (poses.size() < sequence.scans.size()) {
    throw InputError(path.string() + ": " + std::to_string(poses.size()) + " poses for " +
                     std::to_string(sequence.scans.size()) + " scans");
  }
  const Pose T_cam0_velodyne = kitti::ReadCalibration((input / "calib.txt").string());
  const Pose T_first_world = (poses.front() * T_cam0_velodyne).inverse();
  Trajectory truth;
  for (std::size_t i = 0; i < sequence.scans.size(); ++i) {
    truth.Append(sequence.stamps[i], T_first_world * poses[i] * T_cam0_velodyne);
  }
  return truth;
}

sensor_msgs::PointCloud2 ToMessage(const std::vector<Point>& points, const ros::Time& stamp) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.stamp = stamp;
  cloud.header.frame_id = "velodyne";
  for (const char* name : {"x", "y", "z", "intensity"}) {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = 4 * static_cast<std::uint32_t>(cloud.fields.size());
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.height = 1;
  cloud.point_step = kKittiPointStep;
  cloud.row_step = kKittiPointStep * cloud.width;
  cloud.is_dense = true;
  cloud.data.resize(cloud.row_step);
  std::uint8_t* bytes = cloud.data.data();
  for (const Point& point : points) {
    const float values[4] = {point.x, point.y, point.z, point.intensity};
    std::memcpy(bytes, values, sizeof(values));
    bytes += kKittiPointStep;
  }
  return cloud;
}

void WriteScans(const Sequence& sequence, rosbag::Bag& bag, KittiConversion& conversion) {
  ProgressLine progress("hv_kitti_to_bag");
  for (std::size_t i = 0; i < sequence.scans.size(); ++i) {
    bool truncated = false;
    const std::string path = sequence.scans[i].string();
    const std::vector<Point> points = kitti::ReadScan(path, truncated);
    if (truncated) conversion.problems.push_back(path + ": ends inside a point");
    const ros::Time stamp =
        ros::Time().fromNSec(static_cast<std::uint64_t>(sequence.stamps[i].nanoseconds()));
    bag.write("/points", stamp, ToMessage(points, stamp));
    ++conversion.scans;
    progress.Update(double(i + 1) / double(sequence.scans.size()),
                    std::to_string(conversion.scans) + " scans");
  }
}

void WriteBag(const Sequence& sequence, const std::string& bag_path, KittiConversion& conversion) {
  const std::string part = bag_path + ".part";
  try {
    rosbag::Bag bag(part, rosbag::bagmode::Write);
    bag.setCompression(rosbag::compression::LZ4);
    WriteScans(sequence, bag, conversion);
    bag.close();
    fs::rename(part, bag_path);
  } catch (const rosbag::BagException& error) {
    throw InputError(bag_path + ": cannot be written: " + error.what());
  } catch (const fs::filesystem_error& error) {
    throw InputError(bag_path + ": cannot be written: " + error.code().message());
  } catch (const InputError&) {
    fs::remove(part);
    throw;
  }
}

}  // namespace

KittiConversion ConvertKitti(const std::string& input, const std::string& bag_path) {
  const Sequence sequence = FindSequence(input);
  const Trajectory truth = ReadTruth(input, sequence);
  KittiConversion conversion;
  conversion.duration_s = sequence.stamps.back() - sequence.stamps.front();
  WriteBag(sequence, bag_path, conversion);
  if (!truth.empty()) {
    conversion.truth_poses = truth.size();
    conversion.truth_path = (fs::path(bag_path).parent_path() / "truth.tum").string();
    WriteTum(conversion.truth_path, truth);
  }
  return conversion;
}

}  // namespace hv::replay
