#include "hv_core/trajectory.h"

#include <cstdio>
#include <fstream>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "hv_core/error.h"

namespace hv {
namespace {

class TrajectoryFile : public testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }

  Trajectory Read(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return ReadTum(path_);
  }

  std::string ErrorOf(const std::string& text) {
    try {
      Read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  const std::string path_ = testing::TempDir() + "/hv_trajectory_test.tum";
};

Pose PoseAt(double x, double yaw) {
  return MakePose(RotationFromRpy(0.0, 0.0, yaw), Eigen::Vector3d(x, 0.0, 0.0));
}

TEST(Trajectory, SortsAndKeepsTheLastOfEqualStamps) {
  const Trajectory trajectory({{Time::FromSeconds(2.0), PoseAt(2.0, 0.0)},
                               {Time::FromSeconds(1.0), PoseAt(1.0, 0.0)},
                               {Time::FromSeconds(2.0), PoseAt(5.0, 0.0)}});
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(trajectory.poses()[0].pose.translation().x(), 1.0);
  EXPECT_EQ(trajectory.poses()[1].pose.translation().x(), 5.0);
}

TEST(Trajectory, AppendRefusesStampsThatDoNotIncrease) {
  Trajectory trajectory;
  EXPECT_TRUE(trajectory.Append(Time::FromSeconds(1.0), PoseAt(0.0, 0.0)));
  EXPECT_FALSE(trajectory.Append(Time::FromSeconds(1.0), PoseAt(1.0, 0.0)));
  EXPECT_FALSE(trajectory.Append(Time::FromSeconds(0.5), PoseAt(1.0, 0.0)));
  EXPECT_EQ(trajectory.size(), 1U);
}

TEST(Trajectory, InterpolatesPositionAndRotation) {
  const Trajectory trajectory(
      {{Time::FromSeconds(10.0), PoseAt(1.0, 3.0)}, {Time::FromSeconds(12.0), PoseAt(3.0, -3.0)}});
  const std::optional<Pose> pose = trajectory.Interpolate(Time::FromSeconds(10.5));
  ASSERT_TRUE(pose.has_value());
  EXPECT_NEAR(pose->translation().x(), 1.5, 1e-12);
  const double shortest_arc = 2.0 * 3.14159265358979323846 - 6.0;
  EXPECT_NEAR(RotationDistance(*pose, PoseAt(0.0, 3.0 + 0.25 * shortest_arc)), 0.0, 1e-9);
  EXPECT_EQ(trajectory.Interpolate(Time::FromSeconds(10.0))->translation().x(), 1.0);
  EXPECT_EQ(trajectory.Interpolate(Time::FromSeconds(12.0))->translation().x(), 3.0);
}

TEST(Trajectory, DoesNotInterpolateOutsideOrAcrossGaps) {
  const Trajectory trajectory(
      {{Time::FromSeconds(10.0), PoseAt(1.0, 0.0)}, {Time::FromSeconds(12.0), PoseAt(3.0, 0.0)}});
  EXPECT_FALSE(trajectory.Interpolate(Time::FromSeconds(9.999)).has_value());
  EXPECT_FALSE(trajectory.Interpolate(Time::FromSeconds(12.001)).has_value());
  EXPECT_FALSE(trajectory.Interpolate(Time::FromSeconds(11.0), 1.0).has_value());
  EXPECT_FALSE(Trajectory().Interpolate(Time::FromSeconds(0.0)).has_value());
}

TEST(Trajectory, PathLengthSumsSegments) {
  EXPECT_EQ(Trajectory().PathLength(), 0.0);
  const Trajectory trajectory({{Time::FromSeconds(1.0), PoseAt(0.0, 0.0)},
                               {Time::FromSeconds(2.0), PoseAt(3.0, 0.0)},
                               {Time::FromSeconds(3.0), PoseAt(1.0, 0.0)}});
  EXPECT_DOUBLE_EQ(trajectory.PathLength(), 5.0);
}

TEST_F(TrajectoryFile, WriteReadsBack) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Trajectory trajectory;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Quaterniond rotation(normal(random), normal(random), normal(random),
                                      normal(random));
    const Eigen::Vector3d position(1e3 * normal(random), normal(random), normal(random));
    trajectory.Append(Time::FromNanoseconds(1646310000000000001 + i * 100000007LL),
                      MakePose(rotation.normalized(), position));
  }
  WriteTum(path_, trajectory);
  const Trajectory back = ReadTum(path_);
  ASSERT_EQ(back.size(), trajectory.size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    EXPECT_EQ(back.poses()[i].stamp, trajectory.poses()[i].stamp);
    const Pose& expected = trajectory.poses()[i].pose;
    EXPECT_LT((back.poses()[i].pose.translation() - expected.translation()).norm(), 2e-9);
    EXPECT_LT(RotationDistance(back.poses()[i].pose, expected), 1e-9);
  }
}

TEST_F(TrajectoryFile, WriteToMissingFolderIsAnError) {
  EXPECT_THROW(WriteTum("/nonexistent/x.tum", Trajectory()), InputError);
}

TEST_F(TrajectoryFile, ReadsCommentsBlanksCommasAndWindowsLines) {
  const Trajectory trajectory = Read(
      "# stamp x y z qx qy qz qw\r\n\n  \t\n"
      "2.5,1,2,3,0,0,0,1\r\n"
      "1.5\t4 5 6  0 0 0 -1\n"
      "3.5 0 0 0 0 0 0 1.01");
  ASSERT_EQ(trajectory.size(), 3U);
  EXPECT_EQ(trajectory.poses()[0].pose.translation(), Eigen::Vector3d(4.0, 5.0, 6.0));
  EXPECT_EQ(trajectory.poses()[1].stamp, Time::FromSeconds(2.5));
  EXPECT_NEAR(trajectory.poses()[2].pose.linear().determinant(), 1.0, 1e-12);
}

TEST_F(TrajectoryFile, MalformedLinesAreNamed) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  const char* bad_lines[] = {"2 0 0 0 0 0 0",       "2 0 0 0 0 0 0 1 9",   "x 0 0 0 0 0 0 1",
                             "2 nan 0 0 0 0 0 1",   "2 0 0 0 0 0 0 0",     "2 0 0 0 0 0 0 nan",
                             "2 0 0 inf 0 0 0 1",   "1e300 0 0 0 0 0 0 1", "2 0 a 0 0 0 0 1",
                             "2 1e999 0 0 0 0 0 1", "2 0 0 0 9 9 9 9"};
  for (const char* line : bad_lines) {
    const std::string error = ErrorOf(good + line + "\n" + good);
    EXPECT_EQ(error.rfind(path_ + ":2: ", 0), 0U) << line << " gave '" << error << "'";
  }
}

TEST_F(TrajectoryFile, MissingFileIsAnError) {
  EXPECT_THROW(ReadTum("/nonexistent/x.tum"), InputError);
}

TEST_F(TrajectoryFile, FolderIsAnErrorNotAnEmptyTrajectory) {
  EXPECT_THROW(ReadTum(testing::TempDir()), InputError);
}

TEST_F(TrajectoryFile, RandomBytesEitherReadOrRaiseInputError) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> byte(0, 255);
  std::uniform_int_distribution<int> length(0, 200);
  for (int i = 0; i < 300; ++i) {
    std::string text;
    for (int n = length(random); n > 0; --n) text += static_cast<char>(byte(random));
    try {
      Read(text);
    } catch (const InputError&) {
    }
  }
}

TEST_F(TrajectoryFile, MutatedFilesReadToFiniteSortedPosesOrRaiseInputError) {
  std::mt19937 random(6);
  const std::string alphabet = "0123456789.-+e ,\t\n#naif";
  std::uniform_int_distribution<std::size_t> letter(0, alphabet.size() - 1);
  const std::string valid =
      "# c\n1.5 1 2 3 0 0 0 1\n2.5 1.25 2 3 0.5 0.5 0.5 0.5\n3.5 -1e2 2 3 0 0 0.7071 0.7071\n";
  int accepted = 0;
  for (int i = 0; i < 1500; ++i) {
    std::string text = valid;
    std::uniform_int_distribution<std::size_t> at(0, text.size() - 1);
    for (int n = 0; n < 1 + i % 3; ++n) text[at(random)] = alphabet[letter(random)];
    try {
      const Trajectory trajectory = Read(text);
      ++accepted;
      for (std::size_t k = 0; k < trajectory.size(); ++k) {
        ASSERT_TRUE(trajectory.poses()[k].pose.matrix().allFinite()) << text;
        if (k > 0) {
          ASSERT_LT(trajectory.poses()[k - 1].stamp, trajectory.poses()[k].stamp);
        }
      }
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(accepted, 100);
}

}  // namespace
}  // namespace hv
