#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include "small_map.h"

namespace hv {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZI>;

void ExpectEqual(const std::vector<Point>& ours, const Cloud& theirs) {
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    ASSERT_EQ(ours[i].x, theirs[i].x);
    ASSERT_EQ(ours[i].y, theirs[i].y);
    ASSERT_EQ(ours[i].z, theirs[i].z);
    ASSERT_EQ(ours[i].intensity, theirs[i].intensity);
  }
}

TEST(PclExchange, PclReadsOurFiles) {
  const TemporaryFolder folder;
  const std::vector<Point> points = RandomPoints(300, 1);
  for (const PcdEncoding encoding : {PcdEncoding::kBinary, PcdEncoding::kCompressed}) {
    Cloud cloud;
    WritePcd(folder / "a.pcd", points, encoding, Eigen::Vector3f(1.0F, 2.0F, 3.0F));
    ASSERT_EQ(pcl::io::loadPCDFile(folder / "a.pcd", cloud), 0);
    ExpectEqual(points, cloud);
    EXPECT_EQ(cloud.sensor_origin_.head<3>(), Eigen::Vector3f(1.0F, 2.0F, 3.0F));
  }
  Cloud cloud;
  WritePly(folder / "a.ply", points);
  ASSERT_EQ(pcl::io::loadPLYFile(folder / "a.ply", cloud), 0);
  ExpectEqual(points, cloud);
}

TEST(PclExchange, WeReadFilesOfPcl) {
  const TemporaryFolder folder;
  Cloud cloud;
  for (const Point& point : RandomPoints(300, 2)) {
    cloud.emplace_back(point.x, point.y, point.z, point.intensity);
  }
  pcl::io::savePCDFileBinary(folder / "a.pcd", cloud);
  pcl::io::savePCDFileBinaryCompressed(folder / "b.pcd", cloud);
  pcl::PCDWriter().writeASCII(folder / "c.pcd", cloud, 9);
  pcl::io::savePLYFileBinary(folder / "d.ply", cloud);
  for (const char* name : {"a.pcd", "b.pcd", "c.pcd", "d.ply"}) {
    ExpectEqual(ReadPointCloud(folder / name).points, cloud);
  }
}

}  // namespace
}  // namespace hv
