#include "world_markers.h"

#include <gtest/gtest.h>

#include "hv_sim/mesh_builder.h"
#include "hv_sim/pedestrian.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

TEST(WorldMarkersTest, OneLooksInFromAbove) {
  MeshBuilder builder;
  builder.AddBox(Upright({0.0, 0.0, 1.5}), Vector3d(8.0, 6.0, 3.0));
  builder.AddBox(Upright({2.0, 0.0, 0.4}), Vector3d(1.0, 1.0, 0.8));
  const visualization_msgs::Marker marker = WorldMarker(builder.mesh(), "world");
  EXPECT_EQ(marker.header.frame_id, "world");
  EXPECT_EQ(marker.type, visualization_msgs::Marker::TRIANGLE_LIST);
  EXPECT_EQ(marker.points.size() % 3, 0U);
  EXPECT_EQ(marker.points.size(), marker.colors.size());
  int ceiling = 0;
  int table = 0;
  int floor = 0;
  for (std::size_t i = 0; i < marker.points.size(); i += 3) {
    const auto level = [&](double height) {
      return marker.points[i].z == height && marker.points[i + 1].z == height &&
             marker.points[i + 2].z == height;
    };
    ceiling += level(3.0) ? 1 : 0;
    table += marker.points[i].z > 0.79 && marker.points[i].z < 0.81 ? 1 : 0;
    floor += level(0.0) ? 1 : 0;
  }
  EXPECT_EQ(ceiling, 0);
  EXPECT_GT(table, 0);
  EXPECT_GT(floor, 10);
  EXPECT_GT(marker.points.size() / 3, builder.mesh().triangles.size() / 2);
}

TEST(WorldMarkersTest, AGroundUnderTheSkyStays) {
  MeshBuilder builder;
  builder.AddQuad({-5.0, -5.0, 0.0}, {10.0, 0.0, 0.0}, {0.0, 10.0, 0.0});
  EXPECT_EQ(WorldMarker(builder.mesh(), "world").points.size(),
            3U * builder.mesh().triangles.size());
}

TEST(WorldMarkersTest, PeopleStandWhereTheyWalk) {
  PersonPath path;
  path.waypoints = {{0.0, 0.0, 1.0}, {10.0, 0.0, 1.0}};
  path.speed = 1.0;
  const auto array = PeopleMarkers({path, path}, 3.0, "world");
  ASSERT_EQ(array.markers.size(), 2U);
  EXPECT_NE(array.markers[0].id, array.markers[1].id);
  EXPECT_NEAR(array.markers[0].pose.position.x, 3.0, 1e-9);
  EXPECT_NEAR(array.markers[0].pose.position.z - 0.5 * array.markers[0].scale.z, 1.0, 1e-9);
}

}  // namespace
}  // namespace hv::sim
