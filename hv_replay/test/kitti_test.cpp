#include "hv_replay/kitti.h"

#include <cstring>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "hv_core/trajectory.h"
#include "hv_replay/bag_reader.h"
#include "hv_replay/kitti_to_bag.h"

namespace hv::replay::kitti {
namespace {

namespace fs = std::filesystem;

// cam0: x right, y down, z ahead; the LiDAR sits 0.3 m behind and 0.1 m above it.
constexpr char kCalibration[] =
    "P0: 700 0 600 0 0 700 180 0 0 0 1 0\n"
    "Tr: 0 -1 0 0 0 0 -1 -0.1 1 0 0 -0.3\n";

/// A sequence folder that is removed with the test.
class KittiSequence : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_ / "velodyne"); }
  void TearDown() override { fs::remove_all(folder_); }

  void Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }

  /// `count` scans of two points; x of the first is the scan's number.
  void WriteScans(int count) const {
    for (int i = 0; i < count; ++i) {
      const float values[8] = {static_cast<float>(i), 2.0F, 3.0F, 0.5F, -4.0F, 5.0F, 6.0F, 0.25F};
      std::string bytes(sizeof(values), '\0');
      std::memcpy(bytes.data(), values, sizeof(values));
      Write("velodyne/00000" + std::to_string(i) + ".bin", bytes);
    }
  }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  std::string ErrorOf() const {
    try {
      ConvertKitti(folder_.string(), Path("out.bag"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  const fs::path folder_ =
      fs::path(testing::TempDir()) /
      (std::string("hv_kitti_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(KittiSequence, BecomesABagOfCloudsWithoutTime) {
  WriteScans(3);
  const KittiConversion conversion = ConvertKitti(folder_.string(), Path("out.bag"));
  EXPECT_EQ(conversion.scans, 3U);
  EXPECT_NEAR(conversion.duration_s, 0.2, 1e-9);
  EXPECT_TRUE(conversion.truth_path.empty());
  EXPECT_FALSE(fs::exists(folder_ / "truth.tum"));

  std::vector<float> first_x;
  std::vector<std::string> fields;
  BagHandlers handlers;
  handlers.points = [&](const BagCloud& cloud) {
    float x = 0.0F;
    std::memcpy(&x, cloud.view.data, sizeof(x));
    first_x.push_back(x);
    fields.clear();
    for (const PointFieldView& field : cloud.view.fields) fields.push_back(field.name);
    EXPECT_EQ(cloud.view.width, 2U);
    return true;
  };
  BagReader({Path("out.bag")}, {"/points", ""}, ImuNeed::kIgnored).Read(handlers, "test");
  EXPECT_EQ(first_x, (std::vector<float>{0.0F, 1.0F, 2.0F}));
  EXPECT_EQ(fields, (std::vector<std::string>{"x", "y", "z", "intensity"}));
}

TEST_F(KittiSequence, TruthIsOfTheLidarInItsFirstFrame) {
  WriteScans(2);
  Write("calib.txt", kCalibration);
  // The camera goes 1 m ahead (its z) while it turns a quarter to the left (about its y).
  Write("poses.txt", "1 0 0 5 0 1 0 6 0 0 1 7\n0 0 -1 5 0 1 0 6 1 0 0 8\n");
  Write("times.txt", "0.0\n0.104\n");
  const KittiConversion conversion = ConvertKitti(folder_.string(), Path("out.bag"));
  EXPECT_NEAR(conversion.duration_s, 0.104, 1e-9);
  const Trajectory truth = ReadTum(conversion.truth_path);
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_TRUE(truth.poses()[0].pose.isApprox(Pose::Identity(), 1e-9));
  // The LiDAR starts 0.3 m behind the camera, and ends 0.3 m to its right, seen from the start.
  const Pose& end = truth.poses()[1].pose;
  EXPECT_LT((end.translation() - Eigen::Vector3d(1.3, -0.3, 0.0)).norm(), 1e-9);
  EXPECT_LT((end.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-9);
}

TEST_F(KittiSequence, CutScanIsReportedAndTheRestKept) {
  WriteScans(2);
  Write("velodyne/000002.bin", std::string(24, '\0'));
  const KittiConversion conversion = ConvertKitti(folder_.string(), Path("out.bag"));
  EXPECT_EQ(conversion.scans, 3U);
  ASSERT_EQ(conversion.problems.size(), 1U);
  EXPECT_EQ(conversion.problems[0], Path("velodyne/000002.bin") + ": ends inside a point");
}

TEST_F(KittiSequence, FaultsNameFileAndLine) {
  EXPECT_EQ(ErrorOf(), Path("velodyne") + ": holds no scans (*.bin)");
  WriteScans(2);
  Write("times.txt", "0.0\n");
  EXPECT_EQ(ErrorOf(), Path("times.txt") + ": 1 times for 2 scans");
  Write("times.txt", "0.1\n0.1\n");
  EXPECT_EQ(ErrorOf(), Path("times.txt") + ": line 2: earlier than the line before");
  Write("times.txt", "0.1\nten\n");
  EXPECT_EQ(ErrorOf(), Path("times.txt") + ": line 2: not a time in seconds since the first scan");
  Write("times.txt", "0.1\n0.2\n");
  Write("poses.txt", "1 0 0 5 0 1 0 6 0 0 1 7\n");
  EXPECT_EQ(ErrorOf(), Path("poses.txt") + ": 1 poses for 2 scans");
  Write("poses.txt", "1 0 0 5 0 1 0 6 0 0 1 7\n1 0 0 5 0 1 0 6 0 0 1\n");
  EXPECT_EQ(ErrorOf(), Path("poses.txt") + ": line 2: not the twelve numbers of a 3 x 4 matrix");
  Write("poses.txt", "1 0 0 5 0 1 0 6 0 0 1 7\n1 0 0 5 0 2 0 6 0 0 1 7\n");
  EXPECT_EQ(ErrorOf(), Path("poses.txt") + ": line 2: the matrix is not a rigid transform");
  Write("poses.txt", "1 0 0 5 0 1 0 6 0 0 1 7\n1 0 0 5 0 1 0 6 0 0 1 7\n");
  EXPECT_EQ(ErrorOf(), Path("calib.txt") + ": cannot be read");
  Write("calib.txt", "P0: 1 2 3\n");
  EXPECT_EQ(ErrorOf(), Path("calib.txt") + ": no line 'Tr:' with the pose of the LiDAR in cam0");
  EXPECT_FALSE(fs::exists(folder_ / "out.bag"));
  fs::remove_all(folder_ / "velodyne");
  EXPECT_EQ(ErrorOf(), folder_.string() + ": holds no folder velodyne/");
}

}  // namespace
}  // namespace hv::replay::kitti
