#include "hv_relocalize_ndt/prior_map.h"

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "known_hall.h"
#include "small_map.h"

namespace hv::relocalize {
namespace {

std::vector<Point> HallPoints() {
  std::mt19937 random(61);
  std::vector<Point> points;
  for (const Eigen::Vector3f& p : ScanOf(loop::Hall(12), OnRing(0.5, 4.0, 1.0), random)) {
    points.push_back({p.x(), p.y(), p.z(), 1.0F, 0.0F, 0});
  }
  return points;
}

class PriorMapTest : public testing::Test {
 protected:
  PriorMap Load() const { return PriorMap::Load(path_, RelocalizeConfig()); }
  std::string LoadError() const {
    return ErrorOf([this] { Load(); });
  }

  /// A map folder with a cloud and nothing else.
  void SaveCloud(const std::vector<Point>& points) const {
    MapWriter writer(path_);
    writer.AddCloud(points);
    writer.Commit("");
  }

  const TemporaryFolder folder_;
  std::string path_ = folder_ / "map";
};

TEST_F(PriorMapTest, APlainCloudIsAMap) {
  const std::vector<Point> points = HallPoints();
  for (const std::string name : {"hall.pcd", "hall.ply"}) {
    path_ = folder_ / name;
    WritePointCloud(path_, points);
    const PriorMap map = Load();
    EXPECT_EQ(map.name(), path_);
    ASSERT_EQ(map.points().size(), points.size());
    EXPECT_EQ(map.points().back().y(), points.back().y);
    const std::vector<const NdtLevel*> levels = map.Levels();
    ASSERT_EQ(levels.size(), 4U);
    for (std::size_t i = 0; i < levels.size(); ++i) {
      EXPECT_EQ(levels[i]->resolution_m(), RelocalizeConfig().ndt.resolutions_m[i]);
      EXPECT_FALSE(levels[i]->voxels().empty());
    }
    EXPECT_EQ(map.surfaces().resolution_m(), RelocalizeConfig().search.cell_m);
    EXPECT_EQ(map.structure().depth(), RelocalizeConfig().search.depth);
    EXPECT_FALSE(map.session().has_value());
    EXPECT_TRUE(map.PlacesLike(map.points(), Eigen::Vector3d::UnitZ()).empty());
  }
}

TEST_F(PriorMapTest, AFolderWithACloudOnlyIsAMap) {
  SaveCloud(HallPoints());
  const PriorMap map = Load();
  EXPECT_EQ(map.points().size(), HallPoints().size());
  EXPECT_FALSE(map.session().has_value());
}

TEST_F(PriorMapTest, ADamagedCloudIsNamed) {
  SaveCloud(HallPoints());
  const std::string cloud = path_ + "/cloud.pcd";
  std::filesystem::resize_file(cloud, std::filesystem::file_size(cloud) / 2);
  EXPECT_EQ(LoadError().rfind(cloud + ": ", 0), 0U) << LoadError();
  std::ofstream(cloud, std::ios::binary | std::ios::trunc) << "not a point cloud";
  EXPECT_EQ(LoadError().rfind(cloud + ": ", 0), 0U) << LoadError();
  std::filesystem::remove(cloud);
  EXPECT_EQ(LoadError().rfind(cloud + ": ", 0), 0U) << LoadError();
}

TEST_F(PriorMapTest, OneWrongByteInTheCloudIsNoticed) {
  SaveCloud(HallPoints());
  const std::string cloud = path_ + "/cloud.pcd";
  std::fstream file(cloud, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(-7, std::ios::end);
  const int byte = file.peek();
  file.seekp(-7, std::ios::end);
  file.put(static_cast<char>(byte ^ 1));
  file.close();
  EXPECT_EQ(LoadError().rfind(cloud + ": ", 0), 0U) << LoadError();
}

TEST_F(PriorMapTest, WithoutACloudThereIsNoMap) {
  SaveCloud({});
  EXPECT_TRUE(LoadError().find("empty") != std::string::npos) << LoadError();
  path_ = folder_ / "empty.pcd";
  WritePcd(path_, {});
  EXPECT_TRUE(LoadError().find("empty") != std::string::npos) << LoadError();
  path_ = folder_ / "nowhere";
  EXPECT_TRUE(LoadError().find("no such map") != std::string::npos) << LoadError();
  path_ = folder_ / "graph only";
  MapWriter writer(path_);
  writer.AddGraph(SmallGraph(3, 1));
  writer.Commit("");
  EXPECT_NE(LoadError(), "");
}

}  // namespace
}  // namespace hv::relocalize
