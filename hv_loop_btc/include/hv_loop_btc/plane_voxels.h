#pragma once

#include <vector>

#include <Eigen/Core>

namespace hv::loop {

/// A voxel whose points lie on a plane.
struct PlaneVoxel {
  Eigen::Vector3f center = Eigen::Vector3f::Zero();  ///< mean of the points [m]
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float points = 0.0F;
};

struct PlaneVoxelLimits {
  double voxel_m = 0.5;
  int min_points = 10;
  double max_thickness_m = 0.1;  ///< standard deviation across the plane
};

/// The planar voxels of a cloud, in order of first appearance. Normals have no preferred side.
std::vector<PlaneVoxel> ExtractPlaneVoxels(const std::vector<Eigen::Vector3f>& points,
                                           const PlaneVoxelLimits& limits);

/// A large plane: normal . p = offset.
struct ReferencePlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit; upwards when nearly horizontal
  double offset = 0.0;                                ///< [m]
  double support = 0.0;                               ///< plane voxels on it
};

/// The plane that heights are measured from: the floor, that is the best supported horizontal plane
/// below the sensor; without one, the horizontal plane under nearly all points. Gravity is known,
/// so that unlike in methods section 2, step 2, no other plane has to be guessed at: the same floor
/// is found whatever walls are in view.
ReferencePlane FindFloor(const std::vector<PlaneVoxel>& voxels, const Eigen::Vector3d& up,
                         const std::vector<Eigen::Vector3f>& points);

}  // namespace hv::loop
