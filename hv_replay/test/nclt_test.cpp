#include "hv_replay/nclt.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "hv_replay/bag_reader.h"
#include "hv_replay/nclt_to_bag.h"

namespace hv::replay::nclt {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kStart_us = 1326030975000000;
constexpr int kPacketsPerSweep = 180;

template <typename T>
void Put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

void PutHit(std::string& bytes, const Eigen::Vector3d& point, int laser) {
  for (int k = 0; k < 3; ++k) {
    Put(bytes, static_cast<std::uint16_t>(std::lround((point[k] + 100.0) / 0.005)));
  }
  Put(bytes, std::uint8_t{200});
  Put(bytes, static_cast<std::uint8_t>(laser));
}

std::string PacketBytes(std::uint64_t utime, const std::string& hits) {
  std::string bytes;
  for (int k = 0; k < 4; ++k) Put(bytes, std::uint16_t{44444});
  Put(bytes, static_cast<std::uint32_t>(hits.size() / 8));
  Put(bytes, utime);
  Put(bytes, std::uint32_t{0});
  return bytes + hits;
}

double Elevation(int laser) {
  return (laser % 2 == 0 ? -92.0 / 3.0 : -28.0 / 3.0) * M_PI / 180.0 +
         4.0 / 3.0 * (laser / 2) * M_PI / 180.0;
}

/// Hits of one firing on a cylinder of 20 m around the sensor, in sensor axes.
std::string FiringBytes(double azimuth, double vertical_shift = 0.0) {
  std::string bytes;
  for (int laser = 0; laser < 32; ++laser) {
    PutHit(bytes,
           Eigen::Vector3d(20.0 * std::cos(azimuth), 20.0 * std::sin(azimuth),
                           20.0 * std::tan(Elevation(laser)) - vertical_shift),
           laser);
  }
  return bytes;
}

/// `sweeps` revolutions in packets of 12 firings, clockwise.
std::string HitsFile(int sweeps) {
  std::string bytes;
  for (int packet = 0; packet < sweeps * kPacketsPerSweep; ++packet) {
    std::string hits;
    for (int firing = 0; firing < 12; ++firing) {
      const double turns = (packet + firing / 12.0) / kPacketsPerSweep;
      hits += FiringBytes(0.3 - 2.0 * M_PI * turns);
    }
    bytes += PacketBytes(kStart_us + static_cast<std::uint64_t>(packet) * 555, hits);
  }
  return bytes;
}

/// A session folder that is removed with the test.
class NcltSession : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  void WriteFile(const std::string& name, const std::string& bytes) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }

  void WriteImu(int samples) {
    std::string text;
    for (int i = 0; i < samples; ++i) {
      text += std::to_string(kStart_us + static_cast<std::uint64_t>(i) * 20000) +
              ",0.1,0.2,0.3,0.5,0.25,-9.8,0.01,0.02,0.03\n";
    }
    WriteFile("ms25.csv", text);
  }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  std::string ErrorOf() {
    try {
      ConvertNclt(folder_.string(), Path("out.bag"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  const fs::path folder_ =
      fs::path(testing::TempDir()) /
      (std::string("hv_nclt_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST(NcltHits, AreUnsignedAndKeepRangesBeyond63Metres) {
  std::string bytes;
  PutHit(bytes, Eigen::Vector3d(90.005, -99.995, 0.0), 31);
  Put(bytes, std::uint16_t{65535});
  Put(bytes, std::uint16_t{0});
  Put(bytes, std::uint16_t{20000});
  Put(bytes, std::uint8_t{1});
  Put(bytes, std::uint8_t{2});
  bytes += "abc";
  const std::vector<Point> hits =
      DecodeHits(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  ASSERT_EQ(hits.size(), 2U);
  EXPECT_NEAR(hits[0].x, 90.005, 1e-4);
  EXPECT_NEAR(hits[0].y, -99.995, 1e-4);
  EXPECT_EQ(hits[0].ring, 31);
  EXPECT_NEAR(hits[1].x, 227.675, 1e-4);
  EXPECT_NEAR(hits[1].y, -100.0, 1e-4);
  EXPECT_EQ(hits[1].intensity, 1.0F);
}

TEST(NcltHits, VerticalShiftIsRecognised) {
  for (const double shift : {0.0, 1.03, -0.5}) {
    std::string bytes;
    for (int i = 0; i < 100; ++i) bytes += FiringBytes(0.06 * i, shift);
    const std::vector<Point> hits =
        DecodeHits(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    ASSERT_TRUE(VerticalShift(hits).has_value());
    EXPECT_NEAR(*VerticalShift(hits), shift, 5e-3);
  }
  EXPECT_FALSE(VerticalShift({}).has_value());
}

TEST(NcltHits, AreTurnedToForwardLeftUp) {
  // The sensor's x axis points to the vehicle's left (yaw -90.7 deg seen with z down), its z down.
  std::vector<Point> hits(2);
  hits[0].x = 10.0F;
  hits[1].z = 2.0F;
  ToVelodyneFrame(0.0, hits);
  EXPECT_NEAR(hits[0].y, 10.0, 0.01);
  EXPECT_NEAR(hits[0].x, -0.12, 0.01);
  EXPECT_NEAR(hits[1].z, -2.0, 0.01);

  std::vector<Point> in_body(1);
  in_body[0].x = 10.0F;
  in_body[0].y = 1.0F;
  in_body[0].z = -1.0F;
  ToVelodyneFrame(1.03, in_body);
  EXPECT_NEAR(in_body[0].x, 10.0, 1e-6);
  EXPECT_NEAR(in_body[0].y, -1.0, 1e-6);
  EXPECT_NEAR(in_body[0].z, -0.03, 1e-6);
}

TEST(NcltFrames, LidarSitsAboveTheImu) {
  const Eigen::Vector3d t = T_imu_velodyne().translation();
  EXPECT_NEAR(t.x(), 0.112, 1e-9);
  EXPECT_NEAR(t.y(), -0.176, 1e-9);
  EXPECT_NEAR(t.z(), 0.247, 1e-9);
}

TEST_F(NcltSession, PacketsBecomeSweepsOfOneRevolution) {
  WriteFile("velodyne_hits.bin", HitsFile(4));
  HitsReader reader(Path("velodyne_hits.bin"));
  SweepBuilder builder;
  std::vector<Scan> sweeps;
  while (const std::optional<Packet> packet = reader.Next()) {
    if (std::optional<Scan> sweep = builder.Add(*packet)) sweeps.push_back(*sweep);
  }
  if (std::optional<Scan> sweep = builder.Finish()) sweeps.push_back(*sweep);
  EXPECT_FALSE(reader.truncated());
  EXPECT_EQ(reader.skipped_bytes(), 0U);
  ASSERT_GE(sweeps.size(), 4U);
  ASSERT_LE(sweeps.size(), 5U);
  const Scan& sweep = sweeps[1];
  EXPECT_EQ(sweep.points.size(), static_cast<std::size_t>(kPacketsPerSweep * 12 * 32));
  EXPECT_NEAR(sweep.duration, 179 * 555e-6 + 11 * 46.08e-6 + 31 * 1.152e-6, 1e-9);
  EXPECT_NEAR(sweep.points[12 * 32 + 32 + 5].time, 555e-6 + 46.08e-6 + 5 * 1.152e-6, 1e-8);
  std::size_t points = 0;
  for (const Scan& part : sweeps) points += part.points.size();
  EXPECT_EQ(points, static_cast<std::size_t>(4 * kPacketsPerSweep * 12 * 32));
}

TEST_F(NcltSession, ReaderSkipsDamageAndNotesTruncation) {
  const std::string packet = PacketBytes(kStart_us, FiringBytes(0.0));
  WriteFile("a.bin", packet + "garbage" + packet + packet.substr(0, 100));
  HitsReader reader(Path("a.bin"));
  EXPECT_EQ(reader.Next()->hits.size(), 32U);
  EXPECT_EQ(reader.Next()->hits.size(), 32U);
  EXPECT_FALSE(reader.Next().has_value());
  EXPECT_EQ(reader.skipped_bytes(), 7U);
  EXPECT_TRUE(reader.truncated());
}

TEST_F(NcltSession, RandomAndMutatedHitsAreSurvived) {
  std::mt19937 random(9);
  std::uniform_int_distribution<int> byte(0, 255);
  const std::string valid = HitsFile(1).substr(0, 20000);
  for (int round = 0; round < 200; ++round) {
    std::string bytes = round % 2 == 0 ? valid : std::string(2000, '\0');
    if (round % 2 == 1) {
      for (char& c : bytes) c = static_cast<char>(byte(random));
    }
    std::uniform_int_distribution<std::size_t> at(0, bytes.size() - 1);
    for (int k = 0; k < 40; ++k) bytes[at(random)] = static_cast<char>(byte(random));
    bytes.resize(at(random));
    WriteFile("fuzz.bin", bytes);
    HitsReader reader(Path("fuzz.bin"));
    SweepBuilder builder;
    while (const std::optional<Packet> packet = reader.Next()) {
      for (const std::optional<Scan>& sweep : {builder.Add(*packet)}) {
        if (!sweep) continue;
        for (const Point& point : sweep->points) ASSERT_TRUE(std::isfinite(point.time));
      }
    }
  }
}

TEST_F(NcltSession, ImuIsReadInForwardLeftUpAxes) {
  WriteFile("ms25.csv",
            "1326030975020000,0,0,0,1,2,-9.8,0.1,0.2,0.3\r\n"
            "1326030975000000, 0, 0, 0, 1, 2, -9.8, 0.1, 0.2, 0.3\n\n"
            "1326030975020000,0,0,0,1,2,-9.8,0.1,0.2,0.3\n13260309750");
  bool truncated = false;
  const std::vector<ImuSample> samples = ReadMs25(Path("ms25.csv"), truncated);
  EXPECT_TRUE(truncated);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[0].stamp.nanoseconds(), 1326030975000000000);
  EXPECT_EQ(samples[0].acceleration, Eigen::Vector3d(1.0, -2.0, 9.8));
  EXPECT_EQ(samples[0].angular_velocity, Eigen::Vector3d(0.1, -0.2, -0.3));
}

TEST_F(NcltSession, MalformedCsvIsNamedByLine) {
  WriteFile("ms25.csv", "1326030975020000,0,0,0,1,2,-9.8,0.1,0.2,0.3\n1,2,x\n1,2\n");
  bool truncated = false;
  try {
    ReadMs25(Path("ms25.csv"), truncated);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              Path("ms25.csv") + ":2: expected 10 numbers starting with microseconds");
  }
}

TEST_F(NcltSession, RandomCsvEitherReadsOrRaisesInputError) {
  std::mt19937 random(10);
  const std::string alphabet = "0123456789.,-e \n\tnaif\r";
  std::uniform_int_distribution<std::size_t> letter(0, alphabet.size() - 1);
  for (int round = 0; round < 300; ++round) {
    std::string text = "1326030975020000,0,0,0,1,2,-9.8,0.1,0.2,0.3\n";
    text += text;
    std::uniform_int_distribution<std::size_t> at(0, text.size() - 1);
    for (int k = 0; k < round % 8; ++k) text[at(random)] = alphabet[letter(random)];
    WriteFile("ms25.csv", text);
    bool truncated = false;
    try {
      ReadMs25(Path("ms25.csv"), truncated);
      ReadGroundTruth(Path("ms25.csv"));
    } catch (const InputError&) {
    }
  }
}

TEST_F(NcltSession, GroundTruthIsThePoseOfTheImuWithZUp) {
  WriteFile("groundtruth_2012-01-08.csv",
            "1326030975000000,nan,0,0,0,0,0\n"
            "1326030975500000,10,20,-3,0,0,0\n"
            "1326030975600000,10,20,-3,0,0,1.5707963267948966\n");
  const Trajectory truth = ReadGroundTruth(Path("groundtruth_2012-01-08.csv"));
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_LT((truth.poses()[0].pose.translation() - Eigen::Vector3d(9.89, -19.82, 3.71)).norm(),
            1e-9);
  EXPECT_TRUE(truth.poses()[0].pose.linear().isIdentity(1e-9));
  // Heading 90 deg with z down is a turn to the right: forward becomes -y with z up.
  const Eigen::Vector3d forward = truth.poses()[1].pose.linear() * Eigen::Vector3d::UnitX();
  EXPECT_LT((forward + Eigen::Vector3d::UnitY()).norm(), 1e-9);
}

TEST_F(NcltSession, ConvertsToABagThatReadsBack) {
  WriteFile("velodyne_hits.bin", HitsFile(5));
  WriteImu(40);
  WriteFile("groundtruth_2012-01-08.csv", "1326030975000000,1,2,3,0,0,0\n");
  const NcltConversion conversion = ConvertNclt(folder_.string(), Path("out.bag"));
  EXPECT_TRUE(conversion.problems.empty());
  EXPECT_EQ(conversion.imu_samples, 40U);
  EXPECT_EQ(conversion.truth_path, Path("out.tum"));
  EXPECT_EQ(ReadTum(Path("out.tum")).size(), 1U);

  BagReader reader({Path("out.bag")}, {}, ImuNeed::kRequired);
  EXPECT_EQ(reader.topics().points, "/points");
  EXPECT_EQ(reader.topics().imu, "/imu_raw");
  PointCloudDecoder decoder({});
  std::size_t full = 0;
  BagHandlers handlers;
  handlers.points = [&](const BagCloud& cloud) {
    const DecodedScan decoded = decoder.Decode(cloud.view);
    EXPECT_EQ(decoded.error, "");
    if (decoded.scan.points.size() == kPacketsPerSweep * 12 * 32) ++full;
    for (const Point& point : decoded.scan.points) {
      EXPECT_NEAR(std::hypot(point.x, point.y), 20.0, 0.4);
    }
    return true;
  };
  const BagReadResult result = reader.Read(handlers, "test");
  EXPECT_EQ(result.imu_samples, 40U);
  EXPECT_EQ(result.clouds, conversion.sweeps);
  EXPECT_GE(full, 4U);
  EXPECT_EQ(decoder.time_layout()->field, "time");
}

TEST_F(NcltSession, SyncFilesGiveTimesFromAzimuth) {
  std::string hits;
  for (int firing = 0; firing < 1000; ++firing) {
    hits += FiringBytes(1.0 - 2.0 * M_PI * firing / 1000.0, 1.03);
  }
  WriteFile("velodyne_sync/1326030975000000.bin", hits);
  WriteFile("velodyne_sync/1326030975100000.bin", hits + "abc");
  WriteFile("velodyne_sync/notes.bin", "x");
  WriteImu(10);
  const NcltConversion conversion = ConvertNclt(folder_.string(), Path("out.bag"));
  EXPECT_EQ(conversion.sweeps, 2U);
  EXPECT_EQ(conversion.problems.size(), 2U);
  Packet file = {Time(),
                 DecodeHits(reinterpret_cast<const std::uint8_t*>(hits.data()), hits.size())};
  const Scan sweep = SweepFromSync(file);
  EXPECT_NEAR(sweep.points[500 * 32].time, 0.05, 1e-4);
  EXPECT_NEAR(sweep.duration, 0.1, 2e-4);
}

TEST_F(NcltSession, DamagedHitsAreConvertedWithANote) {
  WriteFile("velodyne_hits.bin", HitsFile(2) + "\x01\x02\x03");
  WriteImu(10);
  const NcltConversion conversion = ConvertNclt(folder_.string(), Path("out.bag"));
  ASSERT_EQ(conversion.problems.size(), 1U);
  EXPECT_NE(conversion.problems[0].find("ends inside a packet"), std::string::npos);
  EXPECT_GT(conversion.sweeps, 1U);
}

TEST_F(NcltSession, MissingInputsAreOneLine) {
  EXPECT_NE(ErrorOf().find("ms25.csv: cannot be opened"), std::string::npos);
  WriteImu(10);
  EXPECT_NE(ErrorOf().find("holds neither"), std::string::npos);
  WriteFile("velodyne_hits.bin", "nothing of use");
  EXPECT_NE(ErrorOf().find("no LiDAR sweep"), std::string::npos);
  EXPECT_FALSE(fs::exists(Path("out.bag")));
  EXPECT_FALSE(fs::exists(Path("out.bag.part")));
}

}  // namespace
}  // namespace hv::replay::nclt
