#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hv::replay {

/// What a conversion wrote, and what it had to leave out.
struct NcltConversion {
  std::size_t sweeps = 0;
  std::size_t imu_samples = 0;
  std::size_t truth_poses = 0;
  double duration_s = 0.0;
  std::string truth_path;             ///< empty without ground truth
  std::vector<std::string> problems;  ///< one line each; the bag holds everything else
};

/// Converts one session of the NCLT data set: `velodyne_hits.bin`, or else `velodyne_sync/`, and
/// `ms25.csv` of `input` to a lz4 bag with `/points` (frame `velodyne`, relative time per point)
/// and
/// `/imu_raw` (frame `imu_link`); see nclt.h for the frames. With a `groundtruth_*.csv`, poses of
/// `imu_link` are written beside the bag as a TUM file of the same name. The bag appears under its
/// name only when complete. Throws InputError when an input is missing or the bag cannot be
/// written.
NcltConversion ConvertNclt(const std::string& input, const std::string& bag_path);

}  // namespace hv::replay
