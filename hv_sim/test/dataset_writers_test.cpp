#include "hv_sim/dataset_writers.h"

#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>
#include <yaml-cpp/yaml.h>

#include "box_room.h"
#include "hv_core/error.h"
#include "hv_core/point_cloud_decoder.h"

namespace hv::sim {
namespace {

namespace fs = std::filesystem;

class DatasetTest : public testing::Test {
 protected:
  void SetUp() override {
    directory_ = fs::temp_directory_path() / ("hv_sim_dataset_" + std::to_string(getpid()));
    fs::remove_all(directory_);
  }
  void TearDown() override { fs::remove_all(directory_); }

  DatasetSummary Write(const Recording& recording, const std::string& name, int threads = 1,
                       const std::vector<std::string>& faults = {}) const {
    DatasetOptions options;
    options.directory = Path(name);
    options.threads = threads;
    for (const std::string& text : faults) options.faults.push_back(ParseFault(text));
    return WriteDataset(recording, options);
  }

  std::string Path(const std::string& name) const { return (directory_ / name).string(); }

  fs::path directory_;
};

std::string ReadAll(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

template <typename Message>
std::vector<Message> ReadTopic(const std::string& path, const std::string& topic) {
  rosbag::Bag bag(path, rosbag::bagmode::Read);
  std::vector<Message> messages;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    messages.push_back(*instance.instantiate<Message>());
  }
  return messages;
}

std::vector<Scan> CollectScans(const Recording& recording) {
  std::vector<Scan> scans;
  recording.Stream(1, [&scans](const SensorMessage& message) {
    if (const Scan* scan = std::get_if<Scan>(&message.data)) scans.push_back(*scan);
  });
  return scans;
}

TEST_F(DatasetTest, HiltiBagHasTheFieldsOfTheRealOne) {
  const Recording recording(BoxRoom(20, 14), SmallRecording("hilti", 1.0));
  const DatasetSummary summary = Write(recording, "hilti");
  const auto clouds =
      ReadTopic<sensor_msgs::PointCloud2>(Path("hilti/recording.bag"), "/hesai/pandar");
  const std::vector<Scan> scans = CollectScans(recording);
  ASSERT_EQ(clouds.size(), scans.size());
  EXPECT_EQ(static_cast<std::size_t>(summary.scans), scans.size());
  const std::vector<std::pair<std::string, std::uint32_t>> expected = {
      {"x", 0}, {"y", 4}, {"z", 8}, {"intensity", 16}, {"timestamp", 24}, {"ring", 32}};
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    EXPECT_EQ(clouds[i].header.frame_id, "PandarXT-32");
    EXPECT_EQ(clouds[i].header.stamp.toNSec(),
              static_cast<std::uint64_t>(scans[i].stamp.nanoseconds()));
    ASSERT_EQ(clouds[i].fields.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ(clouds[i].fields[k].name, expected[k].first);
      EXPECT_EQ(clouds[i].fields[k].offset, expected[k].second);
    }
    ASSERT_EQ(clouds[i].width, scans[i].points.size());
    for (std::size_t k = 0; k < scans[i].points.size(); k += 97) {
      const std::uint8_t* bytes = clouds[i].data.data() + k * clouds[i].point_step;
      float xyz[3];
      double timestamp = 0.0;
      std::uint16_t ring = 0;
      std::memcpy(xyz, bytes, sizeof(xyz));
      std::memcpy(&timestamp, bytes + 24, sizeof(timestamp));
      std::memcpy(&ring, bytes + 32, sizeof(ring));
      const Point& point = scans[i].points[k];
      EXPECT_EQ(xyz[0], point.x);
      EXPECT_EQ(xyz[2], point.z);
      EXPECT_EQ(ring, point.ring);
      const double fraction = timestamp - static_cast<double>(clouds[i].header.stamp.sec);
      EXPECT_NEAR(fraction, clouds[i].header.stamp.nsec * 1e-9 + static_cast<double>(point.time),
                  1e-6);
    }
  }
}

TEST_F(DatasetTest, DecoderReturnsTheScans) {
  const Recording recording(BoxRoom(20, 14), SmallRecording("robot", 1.0));
  Write(recording, "robot");
  const auto clouds = ReadTopic<sensor_msgs::PointCloud2>(Path("robot/recording.bag"), "/points");
  const std::vector<Scan> scans = CollectScans(recording);
  ASSERT_EQ(clouds.size(), scans.size());
  PointCloudDecoder decoder{PointCloudDecoderConfig()};
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const DecodedScan decoded = decoder.Decode(ViewOf(clouds[i]));
    ASSERT_EQ(decoded.error, "");
    ASSERT_EQ(decoded.scan.points.size(), scans[i].points.size());
    EXPECT_NEAR(decoded.scan.end() - scans[i].end(), 0.0, 1e-6);
  }
}

TEST_F(DatasetTest, ImuMessagesMatchTheStream) {
  const Recording recording(BoxRoom(20, 14), SmallRecording("hilti", 1.0));
  Write(recording, "hilti");
  const auto messages =
      ReadTopic<sensor_msgs::Imu>(Path("hilti/recording.bag"), "/alphasense/imu");
  std::vector<ImuSample> samples;
  recording.Stream(1, [&samples](const SensorMessage& message) {
    if (const auto* sample = std::get_if<ImuSample>(&message.data)) samples.push_back(*sample);
  });
  ASSERT_EQ(messages.size(), 401U);
  ASSERT_EQ(samples.size(), messages.size());
  for (std::size_t i = 0; i < messages.size(); ++i) {
    EXPECT_EQ(messages[i].header.frame_id, "imu_sensor_frame");
    EXPECT_EQ(messages[i].header.stamp.toNSec(),
              static_cast<std::uint64_t>(samples[i].stamp.nanoseconds()));
    EXPECT_EQ(messages[i].angular_velocity.x, samples[i].angular_velocity.x());
    EXPECT_EQ(messages[i].linear_acceleration.z, samples[i].acceleration.z());
    EXPECT_EQ(messages[i].orientation_covariance[0], -1.0);
  }
  EXPECT_NEAR(messages[50].linear_acceleration.z, -kGravity, 0.3);
}

TEST_F(DatasetTest, RobotBagCarriesItsFrames) {
  const Recording recording(BoxRoom(20, 14), SmallRecording("robot", 0.5));
  Write(recording, "robot");
  const auto messages = ReadTopic<tf2_msgs::TFMessage>(Path("robot/recording.bag"), "/tf_static");
  ASSERT_EQ(messages.size(), 1U);
  ASSERT_EQ(messages[0].transforms.size(), 2U);
  EXPECT_EQ(messages[0].transforms[0].child_frame_id, "imu_link");
  EXPECT_EQ(messages[0].transforms[1].child_frame_id, "lidar_link");
  EXPECT_EQ(messages[0].transforms[1].header.frame_id, "base_link");
  EXPECT_NEAR(messages[0].transforms[1].transform.translation.z, 0.6, 1e-12);
  EXPECT_EQ(ReadTopic<sensor_msgs::Imu>(Path("robot/recording.bag"), "/imu").size(), 101U);
}

TEST_F(DatasetTest, UndistortedPointsLieOnTheWalls) {
  RecordingConfig config = SmallRecording("hilti", 8.0);
  config.motion.style = "aggressive";
  config.lidar_noise = false;
  const Recording recording(BoxRoom(20, 14), config);
  const Time epoch = Time::FromSeconds(config.suite.epoch_s);
  for (const Scan& scan : CollectScans(recording)) {
    for (std::size_t k = 0; k < scan.points.size(); k += 53) {
      const Point& point = scan.points[k];
      const Pose T_world_body =
          recording.BodyAt((scan.stamp - epoch) + static_cast<double>(point.time)).T_world_body;
      const Eigen::Vector3d at = T_world_body * recording.rig().T_body_lidar() *
                                 Eigen::Vector3d(point.x, point.y, point.z);
      ASSERT_LT(recording.lidar().DistanceToSurface(at, 1.0), 1e-3);
    }
  }
}

Pose ReadExtrinsic(const std::string& path) {
  const YAML::Node node = YAML::LoadFile(path)["extrinsic"];
  const auto t = node["translation_m"].as<std::vector<double>>();
  const auto q = node["rotation_xyzw"].as<std::vector<double>>();
  return MakePose(Eigen::Quaterniond(q[3], q[0], q[1], q[2]), Eigen::Vector3d(t[0], t[1], t[2]));
}

TEST_F(DatasetTest, FilesAloneExplainThePoints) {
  for (const std::string format : {"hilti", "robot"}) {
    RecordingConfig config = SmallRecording(format, 6.0);
    config.motion.style = "walk";
    config.lidar_noise = false;
    const Recording recording(BoxRoom(20, 14), config);
    Write(recording, format);
    const Trajectory truth = ReadTum(Path(format + "/truth.tum"));
    const Pose T_imu_lidar = ReadExtrinsic(Path(format + "/calibration.yaml"));
    const std::string topic = format == "robot" ? "/points" : "/hesai/pandar";
    PointCloudDecoder decoder{PointCloudDecoderConfig()};
    std::size_t checked = 0;
    for (const auto& cloud :
         ReadTopic<sensor_msgs::PointCloud2>(Path(format + "/recording.bag"), topic)) {
      const Scan scan = decoder.Decode(ViewOf(cloud)).scan;
      for (std::size_t k = 0; k < scan.points.size(); k += 61) {
        const Point& point = scan.points[k];
        const auto pose = truth.Interpolate(scan.stamp + static_cast<double>(point.time));
        ASSERT_TRUE(pose.has_value());
        const Eigen::Vector3d at = *pose * T_imu_lidar * Eigen::Vector3d(point.x, point.y, point.z);
        ASSERT_LT(recording.lidar().DistanceToSurface(at, 1.0), 0.005) << format;
        ++checked;
      }
    }
    EXPECT_GT(checked, 1000U);
  }
}

TEST_F(DatasetTest, TruthCoversEveryScanEnd) {
  const Recording recording(BoxRoom(20, 14), SmallRecording("hilti", 2.0));
  Write(recording, "hilti");
  const Trajectory truth = ReadTum(Path("hilti/truth.tum"));
  const std::vector<Scan> scans = CollectScans(recording);
  EXPECT_GE(truth.size(), 200U + scans.size());
  const Time epoch = Time::FromSeconds(recording.config().suite.epoch_s);
  const Pose T_body_imu = recording.rig().T_body_imu();
  for (const Scan& scan : scans) {
    const auto pose = truth.Interpolate(scan.end());
    ASSERT_TRUE(pose.has_value());
    const Pose exact = recording.BodyAt(scan.end() - epoch).T_world_body * T_body_imu;
    EXPECT_LT((pose->translation() - exact.translation()).norm(), 1e-7);
  }
}

TEST_F(DatasetTest, SameSeedGivesTheSameBytesForAnyNumberOfThreads) {
  const RecordingConfig config = SmallRecording("hilti", 1.5);
  Write(Recording(BoxRoom(20, 14), config), "one", 1);
  Write(Recording(BoxRoom(20, 14), config), "four", 4);
  RecordingConfig other = config;
  other.seed = 2;
  Write(Recording(BoxRoom(20, 14), other), "other", 1);
  const std::string bytes = ReadAll(Path("one/recording.bag"));
  EXPECT_GT(bytes.size(), 10000U);
  EXPECT_TRUE(bytes == ReadAll(Path("four/recording.bag")));
  EXPECT_FALSE(bytes == ReadAll(Path("other/recording.bag")));
}

TEST_F(DatasetTest, EffectiveConfigurationReadsBack) {
  RecordingConfig config = SmallRecording("robot", 0.5);
  config.suite.imu.rate_hz = 250.0;
  Write(Recording(BoxRoom(20, 14), config), "robot");
  const std::string path = Path("robot/simulation.yaml");
  RecordingConfig read;
  ReadConfig(LoadYamlFile(path), path, read);
  EXPECT_EQ(read.suite.imu.rate_hz, 250.0);
  EXPECT_EQ(ToYaml(read), ToYaml(config));
}

TEST_F(DatasetTest, TruncatedBagIsShorter) {
  const Recording recording(BoxRoom(20, 14), SmallRecording("hilti", 1.0));
  Write(recording, "whole");
  Write(recording, "cut", 1, {"truncated_bag:keep=0.5"});
  const auto whole = static_cast<double>(fs::file_size(Path("whole/recording.bag")));
  EXPECT_NEAR(static_cast<double>(fs::file_size(Path("cut/recording.bag"))) / whole, 0.5, 0.001);
}

TEST_F(DatasetTest, DirectoryThatCannotBeMadeIsOneClearError) {
  const Recording recording(BoxRoom(20, 14), SmallRecording("hilti", 0.5));
  DatasetOptions options;
  options.directory = "/proc/nowhere";
  EXPECT_THROW(WriteDataset(recording, options), InputError);
}

// NCLT files are read back as the documentation of the data set says.

struct Hit {
  double x, y, z;
  int intensity, laser;
};

struct Packet {
  std::uint64_t utime = 0;
  std::vector<Hit> hits;
};

template <typename Value>
Value Take(std::istream& in) {
  Value value{};
  in.read(reinterpret_cast<char*>(&value), sizeof(value));
  return value;
}

Hit TakeHit(std::istream& in) {
  Hit hit{};
  hit.x = Take<std::uint16_t>(in) * 0.005 - 100.0;
  hit.y = Take<std::uint16_t>(in) * 0.005 - 100.0;
  hit.z = Take<std::uint16_t>(in) * 0.005 - 100.0;
  hit.intensity = Take<std::uint8_t>(in);
  hit.laser = Take<std::uint8_t>(in);
  return hit;
}

std::vector<Packet> ReadHits(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::vector<Packet> packets;
  while (in.peek() != std::char_traits<char>::eof()) {
    for (int k = 0; k < 4; ++k) EXPECT_EQ(Take<std::uint16_t>(in), 44444);
    const auto count = Take<std::uint32_t>(in);
    Packet packet;
    packet.utime = Take<std::uint64_t>(in);
    Take<std::uint32_t>(in);
    for (std::uint32_t k = 0; k < count; ++k) packet.hits.push_back(TakeHit(in));
    EXPECT_TRUE(in.good());
    packets.push_back(packet);
  }
  return packets;
}

std::vector<std::vector<double>> ReadCsv(const std::string& path) {
  std::ifstream in(path);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

TEST_F(DatasetTest, NcltHitsReadBackBeyondTheSignedRange) {
  RecordingConfig config = SmallRecording("nclt", 1.0);
  const Recording recording(BoxRoom(150, 30), config);
  Write(recording, "nclt");
  const std::vector<Scan> scans = CollectScans(recording);
  std::vector<Hit> hits;
  std::uint64_t last = 0;
  for (const Packet& packet : ReadHits(Path("nclt/velodyne_hits.bin"))) {
    EXPECT_GT(packet.utime, last);
    last = packet.utime;
    hits.insert(hits.end(), packet.hits.begin(), packet.hits.end());
  }
  std::size_t index = 0;
  double farthest = 0.0;
  for (const Scan& scan : scans) {
    for (const Point& point : scan.points) {
      ASSERT_LT(index, hits.size());
      EXPECT_NEAR(hits[index].x, static_cast<double>(point.x), 0.0026);
      EXPECT_NEAR(hits[index].y, static_cast<double>(point.y), 0.0026);
      EXPECT_NEAR(hits[index].z, static_cast<double>(point.z), 0.0026);
      EXPECT_EQ(hits[index].laser, point.ring);
      farthest = std::max({farthest, hits[index].x, hits[index].y});
      ++index;
    }
  }
  EXPECT_EQ(index, hits.size());
  EXPECT_GT(farthest, 63.9);
}

TEST_F(DatasetTest, NcltSyncFilesHoldARevolutionEach) {
  const Recording recording(BoxRoom(40, 30), SmallRecording("nclt", 1.0));
  Write(recording, "nclt");
  const std::vector<Scan> scans = CollectScans(recording);
  for (const Scan& scan : scans) {
    const std::string name = std::to_string((scan.stamp.nanoseconds() + 500) / 1000) + ".bin";
    EXPECT_EQ(fs::file_size(Path("nclt/velodyne_sync/" + name)), 8 * scan.points.size());
  }
  EXPECT_EQ(scans.size(), 9U);
}

TEST_F(DatasetTest, NcltTruthAndImuHaveZDown) {
  const Recording recording(BoxRoom(40, 30), SmallRecording("nclt", 4.0));
  Write(recording, "nclt");
  const auto truth = ReadCsv(Path("nclt/groundtruth_2012-01-10.csv"));
  const auto imu = ReadCsv(Path("nclt/ms25.csv"));
  ASSERT_EQ(truth.size(), 401U);
  ASSERT_EQ(imu.size(), 401U);
  ASSERT_EQ(truth[0].size(), 7U);
  ASSERT_EQ(imu[0].size(), 10U);
  // The body frame hangs below a LiDAR 0.6 m above the floor.
  EXPECT_NEAR(truth[0][3], -(0.6 - 0.957), 0.05);
  EXPECT_NEAR(truth[0][4], 0.0, 0.05);
  EXPECT_NEAR(imu[10][6], -kGravity, 0.2);
  EXPECT_NEAR(truth[0][1], -3.0, 0.1);
  EXPECT_NEAR(truth[0][2], 2.0, 0.1);
  EXPECT_GT(truth[400][1], truth[0][1] + 0.5) << "drives along x";
  for (const auto& row : truth) {
    const Pose T_down_body = MakePose(RotationFromRpy(row[4], row[5], row[6]),
                                      Eigen::Vector3d(row[1], row[2], row[3]));
    const Time epoch = Time::FromSeconds(recording.config().suite.epoch_s);
    const double seconds = Time::FromNanoseconds(std::llround(row[0]) * 1000) - epoch;
    const Pose T_world_body = recording.BodyAt(seconds).T_world_body * recording.rig().T_body_base;
    const Pose T_down_world = MakePose(RotationFromRpy(M_PI, 0, 0), Eigen::Vector3d::Zero());
    EXPECT_LT(RotationDistance(T_down_body, T_down_world * T_world_body), 1e-4);
  }
}

}  // namespace
}  // namespace hv::sim
