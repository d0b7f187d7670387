#include "hv_sim/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "hv_core/error.h"
#include "hv_sim/floor_plan.h"
#include "hv_sim/lidar.h"
#include "hv_sim/mesh_builder.h"
#include "hv_sim/ray_caster.h"
#include "hv_sim/route.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

std::string WorldErrorOf(const std::string& world) {
  try {
    MakeWorld(world, 1);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

double RouteLength(const std::vector<Vector3d>& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

/// Smallest distance to anything at the heights of a sensor, along a sampled route.
double LeastClearance(const RayCaster& caster, const std::vector<Vector3d>& points) {
  double least = 2.0;
  for (const Vector3d& point : points) {
    for (double height = 0.7; height <= 1.5; height += 0.1) {
      least = std::min(least, caster.Distance(point + height * Vector3d::UnitZ(), 2.0));
    }
  }
  return least;
}

double LargestFloorGap(const RayCaster& caster, const std::vector<Vector3d>& points) {
  constexpr double kUp = 0.4;
  std::vector<Ray> rays;
  for (const Vector3d& point : points) {
    rays.push_back({(point + kUp * Vector3d::UnitZ()).cast<float>(), -Vector3f::UnitZ()});
  }
  std::vector<Hit> hits;
  caster.Cast(rays, 5.0F, hits);
  double gap = 0.0;
  for (const Hit& hit : hits) {
    gap = std::max(gap, std::abs(static_cast<double>(hit.range) - kUp));
  }
  return gap;
}

class EveryWorld : public testing::TestWithParam<std::string> {};

TEST_P(EveryWorld, RouteKeepsClearOfEverythingAndHasFloorUnderIt) {
  const World world = MakeWorld(GetParam(), 3);
  const RayCaster caster(world.mesh);
  for (const double radius : {0.0, 0.5, 1.0}) {
    const std::vector<Vector3d> points = SampleRoute(world.route, world.closed, radius, 0.25);
    EXPECT_GT(RouteLength(points), 100.0);
    EXPECT_GE(LeastClearance(caster, points), 0.6) << "corners rounded by " << radius;
    EXPECT_LE(LargestFloorGap(caster, points), 0.03);
  }
}

TEST_P(EveryWorld, IsMadeOfSoundTriangles) {
  const World world = MakeWorld(GetParam(), 3);
  EXPECT_EQ(world.name, GetParam());
  ASSERT_EQ(world.mesh.triangles.size(), world.mesh.reflectivity.size());
  ASSERT_GT(world.mesh.triangles.size(), 10000U);
  for (const auto& triangle : world.mesh.triangles) {
    for (const std::uint32_t corner : triangle) ASSERT_LT(corner, world.mesh.vertices.size());
  }
  for (const Vector3f& vertex : world.mesh.vertices) ASSERT_TRUE(vertex.allFinite());
  for (const float value : world.mesh.reflectivity) {
    ASSERT_GT(value, 0.0F);
    ASSERT_LE(value, 1.0F);
  }
}

TEST_P(EveryWorld, DependsOnItsSeedAlone) {
  const World one = MakeWorld(GetParam(), 3);
  const World same = MakeWorld(GetParam(), 3);
  const World other = MakeWorld(GetParam(), 4);
  EXPECT_EQ(one.mesh.vertices, same.mesh.vertices);
  EXPECT_EQ(one.mesh.triangles, same.mesh.triangles);
  EXPECT_NE(one.mesh.vertices, other.mesh.vertices);
}

INSTANTIATE_TEST_SUITE_P(All, EveryWorld, testing::ValuesIn(WorldNames()),
                         [](const auto& parameter) { return parameter.param; });

TEST(World, ConstructionRouteClimbsToTheSecondFloorAndBack) {
  const World world = MakeWorld("construction", 1);
  double highest = 0.0;
  for (const Vector3d& point : world.route) highest = std::max(highest, point.z());
  EXPECT_GT(highest, 3.0);
  EXPECT_EQ(world.route.front().z(), 0.0);
  EXPECT_EQ(world.route.back().z(), 0.0);
}

/// Rays downwards along a line from 4 to 16 m beyond `end`, seen from `inside`.
std::vector<Ray> RaysBeyond(const Vector3d& end, const Vector3d& inside, double sideways) {
  const Vector3d ahead = (end - inside).normalized();
  const Vector3d left(-ahead.y(), ahead.x(), 0.0);
  std::vector<Ray> rays;
  for (double along = 4.0; along < 16.0; along += 0.005) {
    const Vector3d from = end + along * ahead + sideways * left + 0.3 * Vector3d::UnitZ();
    rays.push_back({from.cast<float>(), -Vector3f::UnitZ()});
  }
  return rays;
}

TEST(World, TunnelHasAFloorWithoutCracksBeforeItsPortals) {
  const World world = MakeWorld("tunnel", 2);
  const RayCaster caster(world.mesh);
  const std::vector<Vector3d>& route = world.route;
  for (double sideways = -2.0; sideways <= 2.0; sideways += 0.1) {
    for (const std::vector<Ray>& rays :
         {RaysBeyond(route.front(), route[1], sideways),
          RaysBeyond(route.back(), route[route.size() - 2], sideways)}) {
      std::vector<Hit> hits;
      caster.Cast(rays, 0.6F, hits);
      for (const Hit& hit : hits) ASSERT_TRUE(std::isfinite(hit.range));
    }
  }
}

TEST(World, StraightTunnelIsTheSameAllAlongItsMiddle) {
  const World world = MakeWorld("tunnel_straight", 1);
  const RayCaster caster(world.mesh);
  std::vector<Ray> rays;
  for (double x = 35.0; x <= 195.0; x += 7.3) {
    for (double angle = 0.0; angle < 2.0 * M_PI; angle += 0.4) {
      rays.push_back({Vector3f(static_cast<float>(x), 0.0F, 1.0F),
                      Vector3f(0.0F, static_cast<float>(std::cos(angle)),
                               static_cast<float>(std::sin(angle)))});
    }
  }
  std::vector<Hit> hits;
  caster.Cast(rays, 10.0F, hits);
  constexpr std::size_t kDirections = 16;
  for (std::size_t i = kDirections; i < hits.size(); ++i) {
    EXPECT_NEAR(hits[i].range, hits[i % kDirections].range, 1e-4F);
  }
}

TEST(World, StraightTunnelHidesItsEndsFromItsMiddle) {
  const LidarSimulator lidar(MakeWorld("tunnel_straight", 1), PandarXt32(), {}, 1);
  for (const double x : {90.0, 115.0, 140.0}) {
    const Pose pose(Eigen::Translation3d(x, 0.2, 1.2));
    const Scan scan = lidar.Sweep(0.0, [&pose](double) { return pose; });
    ASSERT_GT(scan.points.size(), 50000U);
    for (const Point& point : scan.points) {
      ASSERT_GT(x + static_cast<double>(point.x), 30.1);
      ASSERT_LT(x + static_cast<double>(point.x), 199.9);
    }
  }
}

TEST(World, UnknownNameNamesTheNearest) {
  EXPECT_TRUE(Contains(WorldErrorOf("coridor"), "'corridor'")) << WorldErrorOf("coridor");
  EXPECT_TRUE(Contains(WorldErrorOf("tunnel_strait"), "'tunnel_straight'"));
}

TEST(Route, RoundsCornersByArcsOfTheRadius) {
  const std::vector<Vector3d> route = {{0.0, 0.0, 0.0}, {4.0, 0.0, 0.0}, {4.0, 4.0, 0.0}};
  const std::vector<Vector3d> points = SampleRoute(route, false, 1.0, 0.05);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vector3d& point : points) nearest = std::min(nearest, (point - route[1]).norm());
  EXPECT_NEAR(nearest, std::sqrt(2.0) - 1.0, 1e-3);
  EXPECT_NEAR(RouteLength(points), 6.0 + 0.5 * M_PI, 1e-3);
  EXPECT_EQ(points.front(), route.front());
  EXPECT_EQ(points.back(), route.back());
}

TEST(MeshBuilder, DistancesToAShapeAreThoseOfGeometry) {
  MeshBuilder mesh;
  mesh.AddBox(Pose::Identity(), Vector3d(1.0, 2.0, 3.0));
  const RayCaster caster(mesh.mesh());
  EXPECT_NEAR(caster.Distance({2.0, 0.0, 0.0}, 10.0), 1.5, 1e-6);
  EXPECT_NEAR(caster.Distance({1.5, 2.0, 2.5}, 10.0), std::sqrt(3.0), 1e-6);
  EXPECT_NEAR(caster.Distance({0.0, 0.0, 0.0}, 10.0), 0.5, 1e-6);
  EXPECT_NEAR(caster.Distance({9.0, 0.0, 0.0}, 2.0), 2.0, 1e-6);
}

/// A folder for one test, removed at its end.
class FloorPlanFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("plan_") + info->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }

  std::string WriteYaml(const std::string& changed_from = "", const std::string& to = "") const {
    std::string text =
        "image: plan.pgm\nresolution: 0.25\norigin: [-1.0, -2.0, 0.0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
    if (!changed_from.empty()) text.replace(text.find(changed_from), changed_from.size(), to);
    return Write("plan.yaml", text);
  }

  /// A walled hall of 12 x 8 m with a pillar, as binary PGM.
  std::string Hall() const {
    constexpr int kWidth = 48;
    constexpr int kHeight = 32;
    std::string text = "P5\n# a comment\n48 32\n255\n";
    for (int row = 0; row < kHeight; ++row) {
      for (int column = 0; column < kWidth; ++column) {
        const bool wall = row == 0 || column == 0 || row == kHeight - 1 || column == kWidth - 1;
        const bool pillar = row > 13 && row < 18 && column > 20 && column < 25;
        text.push_back(static_cast<char>(wall || pillar ? 0 : 254));
      }
    }
    return text;
  }

  std::filesystem::path folder_;
};

TEST_F(FloorPlanFile, TextImageIsReadBottomRowFirst) {
  Write("plan.pgm", "P2\n# made by hand\n3 2\n255\n0 254 205\n254 254 0\n");
  const FloorPlan plan = ReadFloorPlan(WriteYaml());
  ASSERT_EQ(plan.width, 3);
  ASSERT_EQ(plan.height, 2);
  EXPECT_EQ(plan.At(0, 0), Cell::kFree);
  EXPECT_EQ(plan.At(2, 0), Cell::kOccupied);
  EXPECT_EQ(plan.At(0, 1), Cell::kOccupied);
  EXPECT_EQ(plan.At(2, 1), Cell::kUnknown);
  EXPECT_TRUE(plan.Center(0, 0).isApprox(Eigen::Vector2d(-0.875, -1.875)));
  const FloorPlan negative = ReadFloorPlan(WriteYaml("negate: 0", "negate: 1"));
  EXPECT_EQ(negative.At(0, 0), Cell::kOccupied);
}

TEST_F(FloorPlanFile, BlocksCoverTheOccupiedCellsOnce) {
  Write("plan.pgm", Hall());
  const FloorPlan plan = ReadFloorPlan(WriteYaml());
  std::vector<int> covered(plan.cells.size(), 0);
  const std::vector<CellBlock> blocks = MergeOccupied(plan);
  for (const CellBlock& block : blocks) {
    for (int row = block.row; row < block.row + block.height; ++row) {
      for (int column = block.column; column < block.column + block.width; ++column) {
        ++covered[static_cast<std::size_t>(row * plan.width + column)];
      }
    }
  }
  for (std::size_t i = 0; i < covered.size(); ++i) {
    EXPECT_EQ(covered[i], plan.cells[i] == Cell::kOccupied ? 1 : 0);
  }
  EXPECT_LE(blocks.size(), 5U);
}

TEST_F(FloorPlanFile, ExtrudedPlanHasWallsWhereThePlanHasThem) {
  Write("plan.pgm", Hall());
  const World world = MakeWorld(WriteYaml(), 1);
  const RayCaster caster(world.mesh);
  // West of the pillar, whose first occupied column is 21: x = -1 + 21 * 0.25 = 4.25 m.
  const Vector3f origin(2.0F, 2.0F, 1.0F);
  std::vector<Hit> hits;
  caster.Cast({{origin, Vector3f::UnitX()},
               {origin, -Vector3f::UnitX()},
               {origin, Vector3f::UnitZ()},
               {origin, -Vector3f::UnitZ()}},
              50.0F, hits);
  EXPECT_NEAR(hits[0].range, 2.25F, 0.01F);
  EXPECT_NEAR(hits[1].range, 2.75F, 0.01F);
  EXPECT_NEAR(hits[2].range, 1.7F, 0.01F);
  EXPECT_NEAR(hits[3].range, 1.0F, 0.01F);
  for (const double radius : {0.0, 1.0}) {
    EXPECT_GE(LeastClearance(caster, SampleRoute(world.route, world.closed, radius, 0.1)), 0.6);
  }
  EXPECT_GT(RouteLength(world.route), 5.0);
}

TEST_F(FloorPlanFile, BadFilesAreNamedWithTheirFault) {
  EXPECT_TRUE(Contains(WorldErrorOf((folder_ / "absent.yaml").string()), "absent.yaml"));
  EXPECT_TRUE(Contains(WorldErrorOf(WriteYaml()), "plan.pgm: cannot be opened"));
  Write("plan.pgm", Hall());
  EXPECT_TRUE(
      Contains(WorldErrorOf(WriteYaml("resolution: 0.25\n", "")), "'resolution' is missing"));
  EXPECT_TRUE(Contains(WorldErrorOf(WriteYaml("0.25", "fine")), "'resolution' has the wrong type"));
  EXPECT_TRUE(Contains(WorldErrorOf(WriteYaml("0.25", "-1")), "resolution must be"));
  EXPECT_TRUE(Contains(WorldErrorOf(WriteYaml("0.0]", "0.5]")), "origin must be"));
  EXPECT_TRUE(Contains(WorldErrorOf(Write("list.yaml", "- 1\n- 2\n")), "not a map_server file"));
  Write("plan.pgm", Hall().substr(0, 600));
  EXPECT_TRUE(Contains(WorldErrorOf(WriteYaml()), "cut short"));
  Write("plan.pgm", "P6\n1 1\n255\nabc");
  EXPECT_TRUE(Contains(WorldErrorOf(WriteYaml()), "not a PGM"));
  Write("plan.pgm", "P5\n-3 2\n255\n");
  EXPECT_TRUE(Contains(WorldErrorOf(WriteYaml()), "width and height"));
  Write("plan.pgm", "P5\n1 1\n65535\nab");
  EXPECT_TRUE(Contains(WorldErrorOf(WriteYaml()), "8-bit"));
  Write("plan.pgm", "P2\n2 1\n255\n7 x\n");
  EXPECT_TRUE(Contains(WorldErrorOf(WriteYaml()), "pixel 1"));
}

TEST_F(FloorPlanFile, RoomTooSmallForARobotIsRefused) {
  Write("plan.pgm", "P2\n4 4\n255\n0 0 0 0 0 254 254 0 0 254 254 0 0 0 0 0\n");
  EXPECT_TRUE(Contains(WorldErrorOf(WriteYaml()), "0.15 m from all walls"));
}

}  // namespace
}  // namespace hv::sim
