#include "hv_replay/bag_reader.h"

#include <cstdio>
#include <cstring>
#include <fstream>
#include <random>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/String.h>

#include "hv_core/error.h"

namespace hv::replay {
namespace {

sensor_msgs::PointCloud2 CloudMessage(double stamp, std::uint32_t points) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.stamp.fromSec(stamp);
  cloud.header.frame_id = "lidar";
  const char* names[] = {"x", "y", "z"};
  for (std::uint32_t k = 0; k < 3; ++k) {
    sensor_msgs::PointField field;
    field.name = names[k];
    field.offset = 4 * k;
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  cloud.width = points;
  cloud.height = 1;
  cloud.point_step = 12;
  cloud.row_step = 12 * points;
  cloud.data.resize(cloud.row_step);
  for (std::uint32_t i = 0; i < points; ++i) {
    const float xyz[3] = {static_cast<float>(i), 2.0F, 3.0F};
    std::memcpy(cloud.data.data() + 12 * i, xyz, sizeof(xyz));
  }
  return cloud;
}

sensor_msgs::Imu ImuMessage(double stamp) {
  sensor_msgs::Imu imu;
  imu.header.stamp.fromSec(stamp);
  imu.header.frame_id = "imu";
  imu.angular_velocity.x = 0.5;
  imu.linear_acceleration.z = 9.81;
  return imu;
}

/// Writes and deletes the bags of one test.
class BagReaderTest : public testing::Test {
 protected:
  void TearDown() override {
    for (const std::string& path : paths_) std::remove(path.c_str());
  }

  std::string NewPath() {
    const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
    paths_.push_back(testing::TempDir() + "/hv_" + test + std::to_string(paths_.size()) + ".bag");
    return paths_.back();
  }

  /// A second of 10 Hz clouds and 100 Hz IMU from `start`.
  std::string WriteBag(double start, const std::string& points_topic = "/points",
                       const std::string& imu_topic = "/imu", bool compressed = true) {
    const std::string path = NewPath();
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    if (compressed) bag.setCompression(rosbag::compression::LZ4);
    bag.setChunkThreshold(10000);
    for (int i = 0; i < 100; ++i) {
      const double stamp = start + 0.01 * i;
      if (!imu_topic.empty()) bag.write(imu_topic, ros::Time(stamp), ImuMessage(stamp));
      if (i % 10 == 0 && !points_topic.empty()) {
        bag.write(points_topic, ros::Time(stamp + 0.1), CloudMessage(stamp, 500));
      }
    }
    std_msgs::String text;
    bag.write("/chatter", ros::Time(start), text);
    bag.close();
    return path;
  }

  static std::string ErrorOf(const std::vector<std::string>& paths, const BagTopics& topics,
                             ImuNeed need = ImuNeed::kRequired) {
    try {
      BagReader reader(paths, topics, need);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  static std::string Bytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }

  std::vector<std::string> paths_;
};

TEST_F(BagReaderTest, FindsTopicsAndHandsMessagesInOrderOfArrival) {
  BagReader reader({WriteBag(1000.0)}, {}, ImuNeed::kRequired);
  EXPECT_EQ(reader.topics().points, "/points");
  EXPECT_EQ(reader.topics().imu, "/imu");
  ASSERT_EQ(reader.all_topics().size(), 3U);
  EXPECT_EQ(reader.all_topics()[1].count, 100U);
  Time last = reader.begin();
  std::size_t points = 0;
  BagHandlers handlers;
  handlers.points = [&](const BagCloud& cloud) {
    EXPECT_GE(cloud.arrival, last);
    last = cloud.arrival;
    EXPECT_EQ(cloud.frame_id, "lidar");
    EXPECT_NEAR(cloud.arrival - cloud.view.stamp, 0.1, 1e-6);
    float x = 0.0F;
    std::memcpy(&x, cloud.view.data + 12 * 7, sizeof(x));
    EXPECT_EQ(x, 7.0F);
    points += cloud.view.width;
    return true;
  };
  handlers.imu = [&](const BagImu& imu) {
    EXPECT_GE(imu.arrival, last);
    last = imu.arrival;
    EXPECT_EQ(imu.sample.angular_velocity.x(), 0.5);
    EXPECT_EQ(imu.sample.acceleration.z(), 9.81);
    return true;
  };
  const BagReadResult result = reader.Read(handlers, "test");
  EXPECT_EQ(result.error, "");
  EXPECT_EQ(result.clouds, 10U);
  EXPECT_EQ(result.imu_samples, 100U);
  EXPECT_EQ(points, 5000U);
}

TEST_F(BagReaderTest, SeveralBagsAreOneStream) {
  const std::string second = WriteBag(1001.0);
  const std::string first = WriteBag(1000.0);
  BagReader reader({second, first}, {}, ImuNeed::kRequired);
  std::vector<Time> stamps;
  BagHandlers handlers;
  handlers.imu = [&stamps](const BagImu& imu) {
    stamps.push_back(imu.sample.stamp);
    return true;
  };
  EXPECT_EQ(reader.Read(handlers, "test").clouds, 20U);
  EXPECT_EQ(stamps.size(), 200U);
  EXPECT_TRUE(std::is_sorted(stamps.begin(), stamps.end()));
}

TEST_F(BagReaderTest, HandlerEndsTheReading) {
  BagReader reader({WriteBag(1000.0)}, {}, ImuNeed::kRequired);
  BagHandlers handlers;
  handlers.points = [](const BagCloud&) { return false; };
  EXPECT_EQ(reader.Read(handlers, "test").clouds, 1U);
}

TEST_F(BagReaderTest, NamedTopicIsFoundWithOrWithoutSlash) {
  const std::string path = WriteBag(1000.0, "/hesai/pandar");
  BagReader reader({path}, {"hesai/pandar", "imu"}, ImuNeed::kRequired);
  EXPECT_EQ(reader.topics().points, "/hesai/pandar");
}

TEST_F(BagReaderTest, MissingTopicIsOneLineListingTheTopics) {
  EXPECT_EQ(ErrorOf({WriteBag(1000.0)}, {"/velodyne_points", ""}),
            "no topic /velodyne_points in the bag; topics are: /chatter (std_msgs/String), "
            "/imu (sensor_msgs/Imu), /points (sensor_msgs/PointCloud2)");
}

TEST_F(BagReaderTest, WrongTypeIsNamed) {
  EXPECT_EQ(ErrorOf({WriteBag(1000.0)}, {"/imu", ""}),
            "topic /imu is of type sensor_msgs/Imu, sensor_msgs/PointCloud2 is needed");
}

TEST_F(BagReaderTest, MissingImuMattersOnlyWhenNeeded) {
  const std::string path = WriteBag(1000.0, "/points", "");
  EXPECT_NE(ErrorOf({path}, {}).find("no sensor_msgs/Imu in the bag"), std::string::npos);
  EXPECT_EQ(ErrorOf({path}, {}, ImuNeed::kOptional), "");
  EXPECT_EQ(ErrorOf({path}, {"", "/imu"}, ImuNeed::kIgnored), "");
}

TEST_F(BagReaderTest, SeveralCandidatesAskForAName) {
  const std::string first = WriteBag(1000.0, "/front");
  const std::string second = WriteBag(1000.0, "/rear");
  EXPECT_NE(ErrorOf({first, second}, {}).find("name one: /front"), std::string::npos);
  EXPECT_EQ(ErrorOf({first, second}, {"/rear", ""}), "");
}

TEST_F(BagReaderTest, BadFilesAreOneLine) {
  EXPECT_NE(ErrorOf({"/nonexistent/a.bag"}, {}).find("/nonexistent/a.bag: cannot be opened"),
            std::string::npos);
  const std::string path = NewPath();
  for (const std::string text : {"", "not a bag at all", "#ROSBAG V2.0\n", "#ROSBAG V1.2\n"}) {
    std::ofstream(path, std::ios::binary) << text;
    const std::string error = ErrorOf({path}, {});
    EXPECT_NE(error.find(path), std::string::npos) << text;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

TEST_F(BagReaderTest, CutOffBagIsReadAsFarAsItGoes) {
  const std::string bytes = Bytes(WriteBag(1000.0));
  const std::string path = NewPath();
  std::size_t last = 0;
  for (const double share : {0.4, 0.6, 0.9, 0.999}) {
    std::ofstream(path, std::ios::binary)
        << bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size())));
    BagReader reader({path}, {}, ImuNeed::kRequired);
    Time newest = reader.begin();
    BagHandlers handlers;
    handlers.points = [&newest](const BagCloud& cloud) {
      EXPECT_EQ(cloud.view.width, 500U);
      EXPECT_GE(cloud.arrival, newest);
      newest = cloud.arrival;
      return true;
    };
    const BagReadResult result = reader.Read(handlers, "test");
    EXPECT_EQ(result.error.find('\n'), std::string::npos);
    EXPECT_NE(
        result.error.find("the bag was cut off after " + std::to_string(result.clouds) + " scans"),
        std::string::npos)
        << result.error;
    EXPECT_GE(result.clouds, last);
    last = result.clouds;
  }
  EXPECT_EQ(last, 10U);
}

TEST_F(BagReaderTest, UnindexedBagIsReadWhole) {
  for (const bool compressed : {true, false}) {
    const std::string whole = WriteBag(1000.0, "/points", "/imu", compressed);
    std::string bytes = Bytes(whole);
    const std::size_t at = bytes.find("index_pos=");
    ASSERT_NE(at, std::string::npos);
    bytes.replace(at + 10, 8, 8, '\0');
    const std::string path = NewPath();
    std::ofstream(path, std::ios::binary) << bytes;
    BagReader reader({path}, {"points", "imu"}, ImuNeed::kRequired);
    ASSERT_EQ(reader.all_topics().size(), 3U);
    EXPECT_EQ(reader.all_topics()[1].type, "sensor_msgs/Imu");
    const BagReadResult result = reader.Read({}, "test");
    EXPECT_EQ(result.clouds, 10U);
    EXPECT_EQ(result.imu_samples, 100U);
    EXPECT_NE(result.error, "");
    EXPECT_NE(ErrorOf({whole, path}, {}).find("rosbag reindex " + path), std::string::npos);
  }
}

TEST_F(BagReaderTest, AnyDamageIsSurvivedOrNamed) {
  const std::string valid = Bytes(WriteBag(1000.0)).substr(0, 60000);
  std::mt19937 random(12);
  std::uniform_int_distribution<int> byte(0, 255);
  const std::string path = NewPath();
  for (int round = 0; round < 150; ++round) {
    std::string bytes = valid;
    std::uniform_int_distribution<std::size_t> at(13, bytes.size() - 1);
    for (int k = 0; k < 1 + round % 20; ++k) bytes[at(random)] = static_cast<char>(byte(random));
    bytes.resize(at(random));
    std::ofstream(path, std::ios::binary) << bytes;
    try {
      BagReader reader({path}, {}, ImuNeed::kOptional);
      EXPECT_NE(reader.Read({}, "test").error, "");
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

TEST_F(BagReaderTest, DamageInTheMiddleKeepsWhatWasRead) {
  const std::string whole = WriteBag(1000.0);
  std::string bytes = Bytes(whole);
  const std::size_t middle = bytes.size() / 2;
  bytes.replace(middle, 2000, 2000, '\x5a');
  const std::string path = NewPath();
  std::ofstream(path, std::ios::binary) << bytes;
  BagReader reader({path}, {}, ImuNeed::kRequired);
  const BagReadResult result = reader.Read({}, "test");
  EXPECT_NE(result.error, "");
  EXPECT_EQ(result.error.find('\n'), std::string::npos);
  EXPECT_GT(result.clouds, 0U);
  EXPECT_LT(result.clouds, 10U);
}

}  // namespace
}  // namespace hv::replay
