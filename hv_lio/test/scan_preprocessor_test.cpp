#include "hv_lio/scan_preprocessor.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "box_room.h"
#include "random_state.h"

namespace hv::lio {
namespace {

/// A body that turns and accelerates; readings for PropagateState in steps of `dt`.
struct TurningBody {
  NavState state;
  ImuStep step;

  TurningBody() {
    state.velocity = Eigen::Vector3d(1.5, -0.5, 0.2);
    step.angular_velocity = Eigen::Vector3d(0.3, -0.5, 2.5);
    step.acceleration = Eigen::Vector3d(0.5, 0.3, 9.9);
    step.dt = 0.0025;
  }

  ScanMotion Move(double duration) {
    ScanMotion motion;
    for (int i = 0; i * step.dt < duration; ++i) {
      motion.knots.push_back(PropagateState(step, state));
      motion.knots.back().time = i * step.dt;
    }
    motion.end_time = duration;
    return motion;
  }
};

TEST(DeskewTest, PointsOfAMovingSweepReturnToTheWalls) {
  TurningBody body;
  const ScanMotion motion = body.Move(0.1);
  const Pose T_imu_lidar = MakePose(RotationFromRpy(0.1, -0.2, 1.0), {0.1, 0.05, -0.2});
  const BoxRoom room;
  std::mt19937 random(1);
  Scan scan = room.Sweep(
      0.0, [&](double time) { return motion.PoseAt(time) * T_imu_lidar; }, 0.0, random);
  const Pose T_room_end = motion.PoseAt(scan.duration);
  ScanMotion to_scan_end = motion;
  to_scan_end.end_time = scan.duration;
  const std::vector<Point> deskewed = Deskew(scan, to_scan_end, T_imu_lidar);
  ASSERT_EQ(deskewed.size(), scan.points.size());
  double worst = 0.0;
  for (const Point& point : deskewed) {
    const Eigen::Vector3d p = T_room_end * Eigen::Vector3d(point.x, point.y, point.z);
    const double gap = std::min((p - room.low).cwiseAbs().minCoeff(),
                                (p - room.high).cwiseAbs().minCoeff());
    worst = std::max(worst, gap);
  }
  EXPECT_LT(worst, 5e-5);
}

TEST(DeskewTest, WithoutMotionOnlyTheExtrinsicActs) {
  ScanMotion motion;
  motion.knots.emplace_back();
  const Pose T_imu_lidar = MakePose(RotationFromRpy(0.0, 0.0, 0.5), {1.0, 2.0, 3.0});
  Scan scan;
  scan.points.push_back({1.0F, 0.0F, 0.0F, 5.0F, 0.0F, 3});
  const std::vector<Point> moved = Deskew(scan, motion, T_imu_lidar);
  EXPECT_NEAR(moved[0].x, 1.0 + std::cos(0.5), 1e-6);
  EXPECT_NEAR(moved[0].y, 2.0 + std::sin(0.5), 1e-6);
  EXPECT_EQ(moved[0].ring, 3);
}

TEST(CellGridTest, MeanScatterAndCountOfEachCell) {
  std::mt19937 random(2);
  std::vector<Point> points;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d p = Eigen::Vector3d(5.25, 2.25, 0.25) + RandomVector(random, 0.03);
    points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()),
                      static_cast<float>(p.z()), 0.0F, 0.0F, 0});
    sum += p;
  }
  points.push_back({9.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0});
  PreprocessConfig config;
  config.cell_size_m = 0.5;
  const std::vector<SurfaceCell> cells = CellGrid(config).Group(points, Eigen::Vector3d::Zero());
  ASSERT_EQ(cells.size(), 2U);
  EXPECT_EQ(cells[0].count, 50.0);
  EXPECT_LT((cells[0].mean - sum / 50.0).norm(), 1e-5);
  EXPECT_NEAR(cells[0].scatter.trace(), 3.0 * 0.03 * 0.03, 1e-3);
  EXPECT_EQ(cells[1].count, 1.0);
  EXPECT_LT(cells[1].scatter.norm(), 1e-9);
  EXPECT_NEAR(cells[1].noise(0, 0), config.range_sigma_m * config.range_sigma_m, 1e-9);
}

TEST(CellGridTest, IsTotalOnEmptyNotFiniteAndHugeInput) {
  CellGrid grid{PreprocessConfig()};
  EXPECT_TRUE(grid.Group({}, Eigen::Vector3d::Zero()).empty());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(grid.Group({{nan, 0, 0, 0, 0, 0}, {0, inf, 0, 0, 0, 0}, {1e30F, 0, 0, 0, 0, 0}},
                         Eigen::Vector3d::Zero())
                  .empty());
}

TEST(CellGridTest, KeepsAtMostMaxCellsOfAVeryDenseCloud) {
  PreprocessConfig config;
  config.cell_size_m = 0.1;
  config.max_cells = 1000;
  std::mt19937 random(3);
  std::vector<Point> points;
  for (int i = 0; i < 200000; ++i) {
    const Eigen::Vector3f p = RandomVector(random, 20.0).cast<float>();
    points.push_back({p.x(), p.y(), p.z(), 0.0F, 0.0F, 0});
  }
  CellGrid grid(config);
  EXPECT_EQ(grid.Group(points, Eigen::Vector3d::Zero()).size(), 1000U);
  points.resize(1);
  EXPECT_EQ(grid.Group(points, Eigen::Vector3d::Zero()).size(), 1U);
}

}  // namespace
}  // namespace hv::lio
