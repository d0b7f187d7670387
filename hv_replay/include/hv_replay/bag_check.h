#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hv_lio/system_config.h"
#include "hv_replay/bag_reader.h"
#include "hv_replay/json.h"
#include "hv_replay/rotation_match.h"
#include "hv_replay/stream_figures.h"

namespace hv::replay {

enum class CheckLevel { kGood, kWarning, kError };

/// One finding: what was looked at, how it looks, and what to do about it.
struct CheckItem {
  CheckLevel level = CheckLevel::kGood;
  std::string name;
  std::string text;
};

struct BagCheckOptions {
  double odometry_s = 30.0;        ///< data from which rotations are compared; 0: none
  double start_s = 0.0;            ///< where in the bag the comparison starts
  bool compare_extrinsic = false;  ///< judge the configured T_imu_lidar
};

/// What point clouds look like.
struct CloudFigures {
  std::string frame_id;
  std::string fields;            ///< "x:float32 ..."
  double points_per_scan = 0.0;  ///< mean, as sent
  double kept_share = 0.0;       ///< finite and within range
  double sweep_s = 0.0;          ///< median duration of a scan
  std::size_t rings = 0;
  std::size_t unusable = 0;  ///< clouds that could not be decoded
  std::string first_error;
  std::optional<PointTimeLayout> time;
};

struct BagCheck {
  StreamFigures points;
  StreamFigures imu;
  CloudFigures cloud;
  ImuFigures readings;
  double covered_share = 0.0;  ///< of scans within the IMU's stamps
  std::optional<RotationMatch> rotation;
  std::vector<CheckItem> items;

  bool HasErrors() const;
};

/// Reads a bag once and looks for everything that spoils odometry. Runs odometry without IMU over a
/// stretch to compare the rotations of both sensors.
BagCheck CheckBag(BagReader& reader, const lio::SystemConfig& config,
                  const BagCheckOptions& options);

/// The findings for a terminal.
std::string CheckReport(const BagCheck& check, bool colour);

/// Findings and figures.
JsonObject CheckJson(const BagCheck& check);

}  // namespace hv::replay
