#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hv_core/scan.h"
#include "hv_core/se3.h"
#include "hv_core/time.h"
#include "hv_relocalize_ndt/global_localizer.h"
#include "hv_relocalize_ndt/localizer_config.h"
#include "hv_relocalize_ndt/map_pose_filter.h"
#include "hv_relocalize_ndt/prior_map.h"
#include "hv_relocalize_ndt/recent_scans.h"

namespace hv::relocalize {

/// One scan as odometry hands it on.
struct TrackedScan {
  Time stamp;
  Pose T_odom_imu = Pose::Identity();   ///< odom is level
  std::uint32_t segment = 0;            ///< odometry of different segments is not connected
  std::vector<Eigen::Vector3f> points;  ///< deskewed, IMU frame at `stamp` [m]
  Eigen::Vector3d lidar_in_imu = Eigen::Vector3d::Zero();  ///< [m]
};

enum class LocalizerState {
  kLost,           ///< where the robot is, is not known
  kDeadReckoning,  ///< the map does not show what is seen here: odometry alone, for a while
  kTracking        ///< scans and map agree
};

const char* ToString(LocalizerState state);

/// What is known after a scan.
struct LocalizerUpdate {
  LocalizerState state = LocalizerState::kLost;
  std::string reason;  ///< why lost or dead reckoning, one line
  Pose T_map_odom = Pose::Identity();
  Pose T_map_imu = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of T_map_imu, right perturbation
  bool registered = false;                 ///< the scan was compared with the map
  bool searched = false;                   ///< and, being lost, with all of it
  PlaceScore score;                        ///< of that comparison
  double innovation = 0.0;                 ///< squared, six degrees of freedom
  bool found = false;                      ///< the search has found the place
  std::string refusal;                     ///< why it has not, one line
  double margin = 0.0;                     ///< of the search: see LocalizationResult
  double lead = 0.0;                       ///< likewise
};

/// Localisation in a prior map (paper 4.4.1): odometry carries the pose at its rate, registrations
/// of scans to the map at a low rate take its drift out. Says that it is lost instead of drifting
/// on, when what the map knows contradicts what is seen, and then looks for its place anywhere in
/// the map: for a scan, or for what was seen along the last metres. Keeps a reference to the map.
/// Not thread-safe.
class Localizer {
 public:
  Localizer(const LocalizerConfig& config, const PriorMap& map);

  /// About where the IMU is now: PoseGuess::T_map_scan is its pose. The next scan is looked for
  /// there.
  void SetGuess(const PoseGuess& guess) { guess_ = guess; }

  /// From now on the place is not known; the next scan is looked for anywhere, or near a guess.
  void Forget();

  /// Takes the next scan, in order of time.
  LocalizerUpdate Add(const TrackedScan& scan);

  /// The same for a scan that there is no time to compare: odometry alone carries the pose along,
  /// its points are not used.
  LocalizerUpdate Skip(const TrackedScan& scan);

  /// The time goes on without a scan: after TrackingConfig::silence_s the place is no longer known.
  LocalizerUpdate Wait(Time now);

 private:
  void Follow(const TrackedScan& scan);
  void Search(const TrackedScan& scan);
  LocalizationQuery QueryOf(const TrackedScan& scan);
  void Register(const TrackedScan& scan);
  void GoOnWithoutMap();
  Matrix6d CovarianceOfComparison(const NdtResult& aligned) const;
  void Weigh(const Pose& T_map_imu, const Matrix6d& covariance);
  void Lose(std::string reason);
  bool Due(Time stamp, double period_s) const;
  LocalizerUpdate Taken();

  LocalizerConfig config_;
  const PriorMap& map_;
  GlobalLocalizer global_;
  NdtRegistration registration_;
  MapPoseFilter filter_;
  RecentScans recent_;  ///< since the place was lost
  std::optional<PoseGuess> guess_;
  LocalizerState state_ = LocalizerState::kLost;
  std::string reason_ = "not localised yet";
  std::optional<Time> last_scan_;
  std::optional<Time> last_comparison_;
  std::uint32_t segment_ = 0;
  int contradictions_ = 0;
  bool together_ = false;   ///< the next search is for recent scans too
  LocalizerUpdate update_;  ///< of the scan at hand
};

}  // namespace hv::relocalize
