#include "hv_navigation/surroundings.h"

#include <limits>

#include <gtest/gtest.h>

#include "hv_navigation/planning_config.h"
#include "solid_scene.h"

namespace hv::navigation {
namespace {

using Eigen::Vector2d;

constexpr double kLidar_m = 0.6;
const DepthCameraModel kCamera{100.0, 100.0, 80.0, 60.0};

Time At(double seconds) { return Time::FromSeconds(1000.0 + seconds); }

/// A robot at the origin on a floor with a wall at x = 4 m.
class SurroundingsTest : public testing::Test {
 protected:
  SurroundingsTest() {
    scene_.AddFloor(-30.0, 30.0);
    scene_.AddBox({4.0, -5.0, 0.0}, {4.4, 5.0, 2.0});
  }

  static std::optional<OccupancyGrid> FreeMap() {
    OccupancyGrid grid;
    grid.origin = {-20.0, -20.0};
    grid.width = grid.height = 400;
    grid.cells.assign(160'000, OccupancyGrid::kFree);
    return grid;
  }

  void Scan(Surroundings& surroundings, double seconds,
            const Pose& T_odom_base = Pose::Identity()) {
    const Pose T_odom_lidar = T_odom_base * Eigen::Translation3d(0.0, 0.0, kLidar_m);
    surroundings.AddScan(At(seconds), scene_.LidarScan(T_odom_lidar, 1.0, 0.0, 1), T_odom_lidar,
                         T_odom_base);
    surroundings.Update(T_odom_base, Pose::Identity());
  }

  /// What the camera sees, pixel by pixel.
  DepthImage Image(double seconds) const {
    DepthImage image;
    image.stamp = At(seconds);
    image.width = 160;
    image.height = 120;
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        const Eigen::Vector3d ray((u - kCamera.cx) / kCamera.fx, (v - kCamera.cy) / kCamera.fy, 1);
        const double range_m =
            scene_.Cast(T_odom_optical_.translation(), T_odom_optical_.linear() * ray.normalized());
        const double depth_m = range_m / ray.norm();
        image.depth_mm.push_back(
            depth_m < 10.0 ? static_cast<std::uint16_t>(std::lround(1000.0 * depth_m)) : 0);
      }
    }
    return image;
  }

  SolidScene scene_;
  MappingConfig config_;
  const double clearance_m_ = PlanningConfig().NeededClearance();
  const Pose T_odom_optical_ = CameraPose(0.2, 0.5, 20.0);
};

TEST_F(SurroundingsTest, WallsAreInBothGrids) {
  Surroundings surroundings(config_, clearance_m_);
  EXPECT_EQ(surroundings.view().local, nullptr);
  EXPECT_EQ(surroundings.view().map, nullptr);
  Scan(surroundings, 0.0);
  Scan(surroundings, 0.1);
  const SurroundingsView& view = surroundings.view();
  ASSERT_NE(view.local, nullptr);
  ASSERT_NE(view.map, nullptr);
  for (const auto& grid : {view.local, view.map}) {
    EXPECT_TRUE(grid->OccupiedAt(Vector2d(4.05, 0.0)));
    EXPECT_NEAR(grid->ClearanceAt(Vector2d(3.45, 0.0)), 0.5, 0.11);
    EXPECT_NEAR(grid->ClearanceAt(Vector2d(0.0, 0.0)), clearance_m_, 1e-6);
  }
  EXPECT_EQ(view.obstacles_stamp, At(0.1));
}

TEST_F(SurroundingsTest, UnseenPlacesOfAGrowingMapMayBeCrossed) {
  const Vector2d behind(4.25 + 2.0, 0.0);
  Surroundings crossing(config_, clearance_m_);
  Scan(crossing, 0.0);
  EXPECT_FALSE(crossing.view().map->OccupiedAt(behind));
  config_.global_grid.cross_unknown = false;
  Surroundings careful(config_, clearance_m_);
  Scan(careful, 0.0);
  EXPECT_TRUE(careful.view().map->OccupiedAt(behind));
}

TEST_F(SurroundingsTest, SavedMapIsThereBeforeTheFirstScanAndIsCorrected) {
  Surroundings surroundings(config_, clearance_m_, FreeMap());
  const auto before = surroundings.view().map;
  ASSERT_NE(before, nullptr);
  EXPECT_TRUE(before->OccupiedAt(Vector2d(25.0, 0.0))) << "beyond it nothing is known";
  Scan(surroundings, 0.0);
  Scan(surroundings, 0.1);
  EXPECT_TRUE(surroundings.view().map->OccupiedAt(Vector2d(4.05, 0.0)));
  EXPECT_FALSE(before->OccupiedAt(Vector2d(4.05, 0.0))) << "grids given out do not change";
}

TEST_F(SurroundingsTest, MapStaysTheSameObjectWhileNothingChanges) {
  Surroundings surroundings(config_, clearance_m_, FreeMap());
  for (int i = 0; i < 10; ++i) Scan(surroundings, 0.1 * i);
  const auto map = surroundings.view().map;
  const auto local = surroundings.view().local;
  Scan(surroundings, 1.0);
  EXPECT_EQ(surroundings.view().map, map);
  EXPECT_NE(surroundings.view().local, local);
}

TEST_F(SurroundingsTest, PartlyMeasuredMapIsThatMeasuredAsAWhole) {
  Surroundings surroundings(config_, clearance_m_, FreeMap());
  for (int i = 0; i < 5; ++i) {
    Scan(surroundings, 0.1 * i, MakePose(RotationFromRpy(0.0, 0.0, 0.1 * i), {0.3 * i, 0.0, 0.0}));
    const ClearanceGrid& map = *surroundings.view().map;
    const ClearanceGrid whole(map.grid(), ClearanceGrid::Unknown::kOccupied, clearance_m_);
    for (int y = 0; y < 400; ++y) {
      for (int x = 0; x < 400; ++x) {
        ASSERT_EQ(map.ClearanceAt(Eigen::Vector2i(x, y)), whole.ClearanceAt(Eigen::Vector2i(x, y)));
      }
    }
  }
}

TEST_F(SurroundingsTest, MapIsLeftAloneWithoutAPlaceInIt) {
  Surroundings surroundings(config_, clearance_m_, FreeMap());
  const auto map = surroundings.view().map;
  const Pose T_odom_lidar = MakePose(Eigen::Matrix3d::Identity(), {0.0, 0.0, kLidar_m});
  for (int i = 0; i < 5; ++i) {
    surroundings.AddScan(At(0.1 * i), scene_.LidarScan(T_odom_lidar, 1.0, 0.0, 1), T_odom_lidar,
                         Pose::Identity());
    surroundings.Update(Pose::Identity(), std::nullopt);
  }
  EXPECT_EQ(surroundings.view().map, map);
  EXPECT_TRUE(surroundings.view().local->OccupiedAt(Vector2d(4.05, 0.0)));
}

TEST_F(SurroundingsTest, CameraAddsWhatIsLow) {
  scene_.AddBox({1.4, -0.3, 0.0}, {1.6, 0.3, 0.15});
  Surroundings surroundings(config_, clearance_m_);
  Scan(surroundings, 0.0);
  EXPECT_FALSE(surroundings.view().local->OccupiedAt(Vector2d(1.45, 0.0)));
  const DepthInsertReport report =
      surroundings.AddDepth(Image(0.1), kCamera, T_odom_optical_, Pose::Identity());
  EXPECT_FALSE(report.image.refused);
  EXPECT_GT(report.points.marked, 100U);
  Scan(surroundings, 0.1);
  EXPECT_TRUE(surroundings.view().local->OccupiedAt(Vector2d(1.45, 0.0)));
}

TEST_F(SurroundingsTest, StampIsThatOfTheSensorThatIsSilentLongest) {
  Surroundings surroundings(config_, clearance_m_);
  Scan(surroundings, 0.0);
  EXPECT_EQ(surroundings.view().obstacles_stamp, At(0.0));
  surroundings.AddDepth(Image(0.05), kCamera, T_odom_optical_, Pose::Identity());
  Scan(surroundings, 0.1);
  EXPECT_EQ(surroundings.view().obstacles_stamp, At(0.05)) << "the camera counts once seen";
  Scan(surroundings, 0.2);
  EXPECT_EQ(surroundings.view().obstacles_stamp, At(0.05));
  surroundings.AddDepth(Image(0.25), kCamera, T_odom_optical_, Pose::Identity());
  EXPECT_EQ(surroundings.view().obstacles_stamp, At(0.2));
}

TEST_F(SurroundingsTest, RequiredCameraIsWaitedFor) {
  config_.depth_image.required = true;
  Surroundings surroundings(config_, clearance_m_);
  Scan(surroundings, 0.0);
  EXPECT_EQ(surroundings.view().obstacles_stamp, Time());
  surroundings.AddDepth(Image(0.05), kCamera, T_odom_optical_, Pose::Identity());
  EXPECT_EQ(surroundings.view().obstacles_stamp, At(0.0));
}

TEST_F(SurroundingsTest, BadDataAreNoData) {
  Surroundings surroundings(config_, clearance_m_);
  Scan(surroundings, 0.0);
  const Pose bad = MakePose(Eigen::Matrix3d::Identity(),
                            Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  Point nowhere;
  nowhere.x = std::numeric_limits<float>::quiet_NaN();
  surroundings.AddScan(At(0.1), {}, Pose::Identity(), Pose::Identity());
  surroundings.AddScan(At(0.1), {nowhere}, Pose::Identity(), Pose::Identity());
  EXPECT_TRUE(surroundings.AddScan(At(0.1), {Point()}, bad, bad).refused);
  DepthImage image = Image(0.1);
  EXPECT_TRUE(surroundings.AddDepth(image, kCamera, bad, bad).points.refused);
  image.depth_mm.pop_back();
  EXPECT_TRUE(
      surroundings.AddDepth(image, kCamera, T_odom_optical_, Pose::Identity()).image.refused);
  const auto local = surroundings.view().local;
  EXPECT_EQ(surroundings.Update(bad, bad).local, local);
  EXPECT_EQ(surroundings.view().obstacles_stamp, At(0.0));
}

TEST_F(SurroundingsTest, ForgottenObstaclesStayUntilTheNextScan) {
  Surroundings surroundings(config_, clearance_m_);
  Scan(surroundings, 0.0);
  surroundings.ForgetObstacles();
  surroundings.Update(Pose::Identity(), Pose::Identity());
  EXPECT_TRUE(surroundings.view().local->OccupiedAt(Vector2d(4.05, 0.0)));
  scene_.RemoveLast();
  Scan(surroundings, 0.1);
  EXPECT_FALSE(surroundings.view().local->OccupiedAt(Vector2d(4.05, 0.0)));
}

TEST_F(SurroundingsTest, WhatIsTooNearToBeSeenStaysWhenTheyLookAgain) {
  // Too low for the LiDAR, and by then behind what the camera sees.
  const Vector2d low(0.65, 0.0);
  const Vector2d wall(4.05, 0.0);
  for (const bool all : {false, true}) {
    Surroundings surroundings(config_, clearance_m_);
    SolidScene before = scene_;
    scene_.AddBox({0.6, -0.1, 0.0}, {0.7, 0.1, 0.15});
    for (int i = 0; i < 3; ++i) {
      surroundings.AddDepth(Image(0.1 * i), kCamera, T_odom_optical_, Pose::Identity());
      Scan(surroundings, 0.1 * i);
    }
    ASSERT_TRUE(surroundings.view().local->OccupiedAt(low));
    scene_ = before;
    scene_.RemoveLast();
    if (all) {
      surroundings.ForgetObstacles();
    } else {
      surroundings.LookAgain();
    }
    Scan(surroundings, 0.3);
    EXPECT_EQ(surroundings.view().local->OccupiedAt(low), !all);
    EXPECT_FALSE(surroundings.view().local->OccupiedAt(wall));
    scene_ = before;
  }
}

TEST_F(SurroundingsTest, ForgottenViewsLeaveTheSavedMap) {
  Surroundings surroundings(config_, clearance_m_, FreeMap());
  Scan(surroundings, 0.0);
  Scan(surroundings, 0.1);
  surroundings.ForgetViews();
  EXPECT_EQ(surroundings.view().map->grid().cells, FreeMap()->cells);
}

TEST_F(SurroundingsTest, SameCallsGiveTheSameGrids) {
  Surroundings first(config_, clearance_m_);
  Surroundings second(config_, clearance_m_);
  for (int i = 0; i < 3; ++i) {
    for (Surroundings* surroundings : {&first, &second}) {
      Scan(*surroundings, 0.1 * i, MakePose(Eigen::Matrix3d::Identity(), {0.2 * i, 0.0, 0.0}));
      surroundings->AddDepth(Image(0.1 * i), kCamera, T_odom_optical_, Pose::Identity());
    }
  }
  EXPECT_EQ(first.view().local->grid().cells, second.view().local->grid().cells);
  EXPECT_EQ(first.view().map->grid().cells, second.view().map->grid().cells);
}

TEST_F(SurroundingsTest, WhatIsFarIsSeenNowAndThen) {
  scene_ = SolidScene();
  scene_.AddFloor(-30.0, 30.0);
  scene_.AddBox({10.0, -5.0, 0.0}, {10.4, 5.0, 2.0});
  Surroundings surroundings(config_, clearance_m_);
  const Vector2d far(10.05, 0.0);
  int seen = 0;
  for (int i = 0; i < 20; ++i) {
    Scan(surroundings, 0.1 * i);
    seen += surroundings.view().local->OccupiedAt(far) ? 1 : 0;
    // Marked by the second view.
    EXPECT_EQ(surroundings.view().map->OccupiedAt(far), i >= 5) << i;
  }
  EXPECT_EQ(seen, 4);
  surroundings.ForgetObstacles();
  Scan(surroundings, 2.1);
  EXPECT_TRUE(surroundings.view().local->OccupiedAt(far));
}

TEST_F(SurroundingsTest, WhoWalksLeavesNoTraceInTheMap) {
  Surroundings surroundings(config_, clearance_m_);
  const SolidScene empty = scene_;
  int told = 0;
  for (int i = 0; i < 30; ++i) {
    const double x = 2.2;
    const double y = -1.5 + 0.1 * i;
    scene_ = empty;
    scene_.AddBox({x - 0.2, y - 0.2, 0.0}, {x + 0.2, y + 0.2, 1.8});
    Scan(surroundings, 0.1 * i);
    const SurroundingsView& view = surroundings.view();
    const Vector2d front(x - 0.15, y);
    EXPECT_TRUE(view.local->OccupiedAt(front)) << i;
    if (i < 10) continue;
    told += view.walkers->all().empty() ? 0 : 1;
    EXPECT_FALSE(view.standing->OccupiedAt(front)) << i;
    EXPECT_FALSE(view.map->OccupiedAt(front)) << i;
    EXPECT_TRUE(view.standing->OccupiedAt(Vector2d(4.05, 4.0))) << i;
  }
  EXPECT_EQ(told, 20);
  for (int i = 30; i < 50; ++i) Scan(surroundings, 0.1 * i);
  // Who stands is an obstacle like any other.
  EXPECT_TRUE(surroundings.view().standing->OccupiedAt(Vector2d(2.05, 1.4)));
  EXPECT_TRUE(surroundings.view().map->OccupiedAt(Vector2d(2.05, 1.4)));
}

TEST_F(SurroundingsTest, FeetOfWhoWalksAreNoLowObstacles) {
  Surroundings surroundings(config_, clearance_m_);
  const SolidScene empty = scene_;
  const double x = 1.3;
  for (int i = 0; i < 30; ++i) {
    const double y = -1.5 + 0.1 * i;
    scene_ = empty;
    scene_.AddBox({x - 0.15, y - 0.15, 0.0}, {x + 0.15, y + 0.15, 1.8});
    // Those of the camera begin when the LiDAR has told who walks, and end before it sees through.
    if (i > 10 && i < 17)
      surroundings.AddDepth(Image(0.1 * i), kCamera, T_odom_optical_, Pose::Identity());
    Scan(surroundings, 0.1 * i);
  }
  scene_ = empty;
  for (int i = 30; i < 50; ++i) Scan(surroundings, 0.1 * i);
  for (double y = -0.3; y < 1.4; y += 0.05) {
    EXPECT_FALSE(surroundings.view().local->OccupiedAt(Vector2d(x - 0.1, y))) << y;
  }
}

}  // namespace
}  // namespace hv::navigation
