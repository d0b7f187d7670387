#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hv::replay {

/// What a conversion wrote, and what it had to leave out.
struct KittiConversion {
  std::size_t scans = 0;
  std::size_t truth_poses = 0;
  double duration_s = 0.0;            ///< from the first to the last scan
  std::string truth_path;             ///< empty without true poses
  std::vector<std::string> problems;  ///< one line each; the bag holds everything else
};

/// Converts one sequence of the KITTI odometry benchmark, a folder with `velodyne/*.bin`, to a lz4
/// bag with `/points` (frame `velodyne`, no time field: the clouds are deskewed already). Stamps
/// come from `times.txt`, or 10 Hz without it, counted from noon of the first recording day
/// (2011-09-26 UTC). With `poses.txt` (cam0; needs `calib.txt`), poses of the LiDAR in its first
/// frame are written beside the bag as `truth.tum`. The bag appears under its name only when
/// complete. Throws InputError when an input is missing or malformed, or the bag cannot be written.
KittiConversion ConvertKitti(const std::string& input, const std::string& bag_path);

}  // namespace hv::replay
