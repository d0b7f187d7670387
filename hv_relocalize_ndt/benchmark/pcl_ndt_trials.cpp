// The trials of hv_relocalize_eval by the NDT of PCL, for comparison: reads its CSV with the
// guesses, writes one with the same names of columns.
#include <pcl/filters/voxel_grid.h>
#include <pcl/registration/ndt.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "hv_core/point_cloud_file.h"

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Row = std::map<std::string, std::string>;

std::vector<Row> ReadCsv(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> names;
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::vector<std::string> values;
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(cell);
    if (names.empty()) {
      names = values;
      continue;
    }
    Row row;
    for (std::size_t i = 0; i < names.size() && i < values.size(); ++i) row[names[i]] = values[i];
    rows.push_back(row);
  }
  return rows;
}

Eigen::Isometry3d PoseOf(const Row& row, const std::string& name) {
  const auto value = [&](const char* part) { return std::stod(row.at(name + "_" + part)); };
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() =
      Eigen::Quaterniond(value("qw"), value("qx"), value("qy"), value("qz")).toRotationMatrix();
  pose.translation() << value("x"), value("y"), value("z");
  return pose;
}

Cloud::Ptr Load(const std::string& path) {
  Cloud::Ptr cloud(new Cloud);
  for (const hv::Point& point : hv::ReadPointCloud(path).points) {
    cloud->push_back({point.x, point.y, point.z});
  }
  return cloud;
}

Cloud::Ptr Thinned(const Cloud::Ptr& cloud, float leaf_m) {
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(leaf_m, leaf_m, leaf_m);
  Cloud::Ptr thinned(new Cloud);
  grid.filter(*thinned);
  return thinned;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: pcl_ndt_trials MAP.pcd CLOUDS TRIALS.csv OUT.csv\n";
    return 1;
  }
  const Cloud::Ptr map = Load(argv[1]);
  pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ> ndt;
  ndt.setResolution(1.0F);
  ndt.setStepSize(0.5);
  ndt.setTransformationEpsilon(1e-4);
  ndt.setMaximumIterations(60);
  ndt.setInputTarget(map);
  std::ofstream out(argv[4]);
  out << "trial,cloud,localized,error_m,error_deg,ms\n";
  for (const Row& row : ReadCsv(argv[3])) {
    const Cloud::Ptr scan = Load(std::string(argv[2]) + "/" + row.at("cloud"));
    const auto start = std::chrono::steady_clock::now();
    ndt.setInputSource(Thinned(scan, 0.25F));
    Cloud aligned;
    ndt.align(aligned, PoseOf(row, "guess").matrix().cast<float>());
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - start;
    Eigen::Isometry3d found = Eigen::Isometry3d::Identity();
    found.matrix() = ndt.getFinalTransformation().cast<double>();
    const Eigen::Isometry3d truth = PoseOf(row, "truth");
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(truth.linear().transpose() * found.linear()));
    out << row.at("trial") << ',' << row.at("cloud") << ",1,"
        << (found.translation() - truth.translation()).norm() << ','
        << std::abs(turn.angle()) * 180.0 / M_PI << ',' << elapsed.count() << '\n';
  }
  return 0;
}
