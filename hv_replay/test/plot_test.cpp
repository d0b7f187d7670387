#include "hv_replay/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "hv_replay/curve_plot.h"
#include "hv_replay/drive_picture.h"
#include "hv_replay/map_picture.h"
#include "plot/axes.h"

namespace hv::replay {
namespace {

using plot::NiceTicks;
using plot::TickText;

/// Owns the file a test draws.
class PlotFile : public testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }
  const std::string path_ = testing::TempDir() + "/hv_plot_test.png";
};

Trajectory Circle(double radius) {
  Trajectory trajectory;
  for (int i = 0; i < 200; ++i) {
    const double angle = 0.03 * i;
    const Eigen::Vector3d position(radius * std::cos(angle), radius * std::sin(angle), 0.01 * i);
    trajectory.Append(Time::FromSeconds(100.0 + 0.1 * i),
                      MakePose(RotationFromRpy(0, 0, angle), position));
  }
  return trajectory;
}

/// Pixels that differ clearly from the corner's colour.
int DrawnPixels(const cv::Mat& image) {
  const cv::Vec3b background = image.at<cv::Vec3b>(0, 0);
  int drawn = 0;
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      drawn += cv::norm(image.at<cv::Vec3b>(row, column), background) > 60.0 ? 1 : 0;
    }
  }
  return drawn;
}

TEST(Ticks, AreRoundAndInsideTheRange) {
  EXPECT_EQ(NiceTicks({0.0, 10.0}, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  const std::vector<double> small = NiceTicks({0.013, 0.041}, 3);
  ASSERT_EQ(small.size(), 3U);
  EXPECT_NEAR(small[0], 0.02, 1e-12);
  EXPECT_NEAR(small[2], 0.04, 1e-12);
  for (const double span : {1e-9, 1e-3, 7.0, 123.4, 1e6}) {
    const std::vector<double> ticks = NiceTicks({-span, span}, 6);
    EXPECT_GE(ticks.size(), 3U) << span;
    EXPECT_LE(ticks.size(), 9U) << span;
  }
  EXPECT_EQ(NiceTicks({5.0, 5.0}, 5).size(), 1U);
  EXPECT_EQ(NiceTicks({0.0, std::numeric_limits<double>::infinity()}, 5).size(), 1U);
}

TEST(Ticks, TextHasTheDecimalsOfItsStep) {
  EXPECT_EQ(TickText(2.0, 1.0), "2");
  EXPECT_EQ(TickText(0.25, 0.05), "0.25");
  EXPECT_EQ(TickText(-1e-17, 0.1), "0.0");
  EXPECT_EQ(TickText(1500.0, 500.0), "1500");
}

TEST(Axes, MapDataToPixels) {
  plot::Canvas canvas(400, 300, plot::kWhite);
  const plot::PixelRect area = {50.0, 20.0, 350.0, 120.0};
  const plot::Axes axes = plot::Axes::EqualScale(canvas, area, {0.0, 10.0}, {0.0, 10.0});
  const plot::PixelPoint origin = axes.ToPixel(0.0, 0.0);
  const plot::PixelPoint right = axes.ToPixel(1.0, 0.0);
  const plot::PixelPoint above = axes.ToPixel(0.0, 1.0);
  EXPECT_NEAR(right.x - origin.x, origin.y - above.y, 1e-9);
  EXPECT_GT(right.x, origin.x);
  EXPECT_GT(axes.ToPixel(0.0, 10.0).y, area.top);
  EXPECT_LT(origin.y, area.bottom);
}

TEST_F(PlotFile, ErrorFigureIsDrawn) {
  const TrajectoryError error = CompareTrajectories(Circle(10.0), Circle(10.1), {});
  PlotError(error, "test", path_);
  const cv::Mat image = cv::imread(path_);
  ASSERT_EQ(image.size(), cv::Size(1600, 900));
  EXPECT_GT(DrawnPixels(image), 8000);
}

TEST_F(PlotFile, TrajectoriesAreDrawnWithTheReferenceBelow) {
  PlotTrajectories({{"estimate", Circle(10.0), false}, {"truth", Circle(10.0), true}}, "t", path_);
  const cv::Mat image = cv::imread(path_);
  int blue = 0;
  for (int row = 110; row < 640; ++row) {
    for (int column = 80; column < 1560; ++column) {
      const cv::Vec3b pixel = image.at<cv::Vec3b>(row, column);
      blue += pixel[0] > 200 && pixel[2] < 80 ? 1 : 0;
    }
  }
  EXPECT_GT(blue, 1000);
}

TEST_F(PlotFile, DegenerateInputIsDrawnToo) {
  Trajectory still;
  still.Append(Time::FromSeconds(1.0), Pose::Identity());
  PlotTrajectories({{"still", still, false}}, "", path_);
  TrajectoryErrorOptions options;
  options.alignment = Alignment::kNone;
  PlotError(CompareTrajectories(still, still, options), "", path_);
  EXPECT_FALSE(cv::imread(path_).empty());
}

/// Pixels that are more red than anything else.
int RedPixels(const cv::Mat& image) {
  int red = 0;
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      const cv::Vec3b pixel = image.at<cv::Vec3b>(row, column);
      red += pixel[2] > 180 && pixel[0] < 80 && pixel[1] < 80 ? 1 : 0;
    }
  }
  return red;
}

TEST_F(PlotFile, DrivesThatFailedAreRed) {
  OccupancyGrid map;
  map.width = 60;
  map.height = 40;
  map.cells.assign(60 * 40, OccupancyGrid::kFree);
  DrivenLine line;
  for (int k = 0; k < 50; ++k) line.points.emplace_back(0.5 + 0.1 * k, 2.0);
  line.goal = line.points.back();
  DrawDrives(map, {line}, "test", path_);
  const int legend = RedPixels(cv::imread(path_));
  line.failed = true;
  DrawDrives(map, {line}, "test", path_);
  EXPECT_GT(RedPixels(cv::imread(path_)), legend + 1000);
  EXPECT_THROW(DrawDrives(OccupancyGrid(), {line}, "test", path_), InputError);
}

TEST_F(PlotFile, NothingToDrawAndBadPathsAreErrors) {
  EXPECT_THROW(PlotTrajectories({}, "", path_), InputError);
  EXPECT_THROW(PlotError(TrajectoryError(), "", path_), InputError);
  EXPECT_THROW(MapPicture().Save(Trajectory(), "", path_), InputError);
  EXPECT_THROW(PlotTrajectories({{"a", Circle(1.0), false}}, "", "/nonexistent/a.png"), InputError);
  EXPECT_THROW(PlotTrajectories({{"a", Circle(1.0), false}}, "", path_ + ".xyz"), InputError);
}

TEST_F(PlotFile, MapShowsWallsBrighterThanFloor) {
  MapPicture map(0.05);
  for (int i = 0; i < 200; ++i) {
    for (int k = 0; k < 200; ++k) map.Add({0.05 * i + 0.02, 0.05 * k + 0.02, 0.0});
    for (int k = 0; k < 60; ++k) map.Add({0.05 * i + 0.02, 5.02, 0.05 * k});
  }
  map.Add({1e9, 0.0, 0.0});
  map.Add({std::nan(""), 0.0, 0.0});
  EXPECT_EQ(map.cells(), 200U * 200U);
  map.Save(Trajectory(), "", path_);
  const cv::Mat image = cv::imread(path_);
  const auto brightness = [&image](double down) {
    const cv::Vec3b pixel =
        image.at<cv::Vec3b>(static_cast<int>(down * image.rows), image.cols / 2);
    return pixel[0] + pixel[1] + pixel[2];
  };
  EXPECT_GT(brightness(0.498), brightness(0.3) + 150);
  EXPECT_GT(brightness(0.3), brightness(0.01) + 15);
}

TEST_F(PlotFile, PathOnAMapIsInterruptedWhereItIsUnknown) {
  MapPicture map(0.1);
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < 100; ++k) map.Add({0.1 * i + 0.05, 0.1 * k + 0.05, 0.0});
  }
  const auto whiteness_between = [&](double gap_s) {
    std::vector<StampedPose> poses(2);
    poses[0] = {Time::FromSeconds(100.0), MakePose(Eigen::Matrix3d::Identity(), {1.0, 5.0, 0.0})};
    poses[1] = {poses[0].stamp + gap_s, MakePose(Eigen::Matrix3d::Identity(), {9.0, 5.0, 0.0})};
    map.Save(Trajectory(poses), "", path_);
    const cv::Mat image = cv::imread(path_);
    int most = 0;
    for (int row = 0; row < image.rows; ++row) {
      const cv::Vec3b pixel = image.at<cv::Vec3b>(row, image.cols / 2);
      most = std::max(most, static_cast<int>(std::min({pixel[0], pixel[1], pixel[2]})));
    }
    return most;
  };
  EXPECT_GT(whiteness_between(0.1), 230);
  EXPECT_LT(whiteness_between(5.0), 230);
}

TEST_F(PlotFile, CurvesLeaveOutWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  PlotCurves({{"loss", "updates", "", {{"loss", {1, 2, 3, 4}, {4, nan, 2, 1}}}},
              {"nothing", "updates", "", {{"none", {1}, {nan}}}}},
             "Training", path_);
  const cv::Mat image = cv::imread(path_);
  ASSERT_FALSE(image.empty());
  EXPECT_GT(DrawnPixels(image), 1000);
}

TEST_F(PlotFile, CurvesComeFromATableInTheirOrder) {
  const std::string table = testing::TempDir() + "/hv_plot_test.csv";
  WriteFile(table, {"panel,curve,x,y\nb,one,0,1\na,one,0,2\nb,two,0,3\nb,one,1,4.5\n"});
  const std::vector<CurvePanel> panels = ReadCurvePanels(table);
  ASSERT_EQ(panels.size(), 2U);
  EXPECT_EQ(panels[0].title, "b");
  ASSERT_EQ(panels[0].curves.size(), 2U);
  EXPECT_EQ(panels[0].curves[0].name, "one");
  EXPECT_EQ(panels[0].curves[0].x, (std::vector<double>{0, 1}));
  EXPECT_EQ(panels[0].curves[0].y, (std::vector<double>{1, 4.5}));
  for (const char* bad : {"panel,curve\n", "panel,curve,x,y\n", "panel,curve,x,y\nb,one,0\n",
                          "panel,curve,x,y\nb,one,0,1,2\n"}) {
    WriteFile(table, {bad});
    EXPECT_THROW(ReadCurvePanels(table), InputError) << bad;
  }
  std::remove(table.c_str());
}

}  // namespace
}  // namespace hv::replay
