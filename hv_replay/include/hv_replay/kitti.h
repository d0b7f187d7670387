#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hv_core/scan.h"
#include "hv_core/se3.h"

/// Readers of the KITTI odometry benchmark (Geiger, Lenz, Urtasun, CVPR 2012). All throw InputError
/// naming file and fault.
namespace hv::replay::kitti {

/// Reads one file of `velodyne/`: x, y, z [m] and intensity as float32, of a cloud that its makers
/// have deskewed. An incomplete point at the end is left out and `truncated` set.
std::vector<Point> ReadScan(const std::string& path, bool& truncated);

/// T_cam0_velodyne: the line "Tr:" of calib.txt, twelve numbers of a 3 x 4 matrix by rows.
Pose ReadCalibration(const std::string& path);

/// A file of true poses of cam0 in its first frame: twelve numbers of a 3 x 4 matrix a line.
std::vector<Pose> ReadPoses(const std::string& path);

/// times.txt: seconds since the first scan, strictly increasing, one a line.
std::vector<double> ReadTimes(const std::string& path);

}  // namespace hv::replay::kitti
