#include "hv_loop_btc/map_builder.h"

#include <cstdio>
#include <filesystem>

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include "hv_core/error.h"
#include "simulated_room.h"

namespace hv::loop {
namespace {

constexpr int kScans = 30;

struct Counts {
  double still = 0.0;
  double moving = 0.0;
};

class MapBuilderTest : public testing::Test {
 protected:
  BuiltMap Build(bool with_walker, const MapBuilderConfig& config) const {
    std::mt19937 random(5);
    return MapBuilder(config).Build(
        room_.Vertices(kScans),
        [&](std::uint32_t id) {
          random.seed(id);
          return room_.Scan(static_cast<int>(id), with_walker, random);
        },
        occupancy_path_);
  }

  Counts Count(const std::vector<Point>& cloud) const {
    Counts counts;
    for (const Point& point : cloud) {
      const Eigen::Vector3d position(point.x, point.y, point.z);
      (room_.DistanceToStatic(position) < 0.06 ? counts.still : counts.moving) += 1.0;
    }
    return counts;
  }

  std::int8_t CellAt(const OccupancyGrid& grid, double x, double y) const {
    const int column = static_cast<int>(std::floor((x - grid.origin.x()) / grid.resolution_m));
    const int row = static_cast<int>(std::floor((y - grid.origin.y()) / grid.resolution_m));
    if (column < 0 || row < 0 || column >= grid.width || row >= grid.height) {
      return OccupancyGrid::kUnknown;
    }
    return grid.At(column, row);
  }

  void TearDown() override {
    if (!occupancy_path_.empty()) std::remove(occupancy_path_.c_str());
  }

  SimulatedRoom room_;
  std::string occupancy_path_;
};

TEST_F(MapBuilderTest, RemovesAWalkerAndKeepsTheRoom) {
  MapBuilderConfig config;
  const Counts filtered = Count(Build(true, config).cloud);
  config.remove_moving = false;
  const Counts all = Count(Build(true, config).cloud);
  ASSERT_GT(all.moving, 1000.0);
  RecordProperty("moving_removed_permille",
                 static_cast<int>(1e3 * (1 - filtered.moving / all.moving)));
  std::printf("moving %.0f of %.0f left, still %.0f of %.0f\n", filtered.moving, all.moving,
              filtered.still, all.still);
  EXPECT_LT(filtered.moving, 0.1 * all.moving);
  EXPECT_GT(filtered.still, 0.99 * all.still);
}

TEST_F(MapBuilderTest, ARoomWithoutWalkerStaysWhole) {
  MapBuilderConfig config;
  const BuiltMap filtered = Build(false, config);
  config.remove_moving = false;
  const BuiltMap all = Build(false, config);
  std::printf("removed %zu of %zu\n", filtered.moving_voxels, all.cloud.size());
  EXPECT_LT(static_cast<double>(filtered.moving_voxels),
            0.005 * static_cast<double>(all.cloud.size()));
}

}  // namespace
}  // namespace hv::loop
