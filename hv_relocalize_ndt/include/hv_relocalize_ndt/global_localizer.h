#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/se3.h"
#include "hv_relocalize_ndt/place_score.h"
#include "hv_relocalize_ndt/pose_search.h"
#include "hv_relocalize_ndt/prior_map.h"
#include "hv_relocalize_ndt/relocalize_config.h"

namespace hv::relocalize {

/// About where a scan was taken.
struct PoseGuess {
  Pose T_map_scan = Pose::Identity();
  double radius_m = 0.0;     ///< how far off it may be; 0: RelocalizeConfig::guess_radius_m
  double heading_rad = 0.0;  ///< and its heading; 0: RelocalizeConfig::guess_heading_deg
};

/// What is to be found in a map.
struct LocalizationQuery {
  /// One scan, or several as one cloud; the sensor was at the origin of their frame [m].
  std::vector<Eigen::Vector3f> points;
  /// Against gravity in that frame, where an IMU knows it. Else it is read off floors and walls,
  /// from the z axis, or that of the guess, to 30 deg.
  std::optional<Eigen::Vector3d> up;
  std::optional<PoseGuess> guess;  ///< without, anywhere
};

/// A pose that has been followed up.
struct LocalizationCandidate {
  Pose T_map_scan = Pose::Identity();
  std::string origin;  ///< what proposed it
  PlaceScore score;
};

/// The answer.
struct LocalizationResult {
  bool localized = false;
  std::string reason;  ///< why not, one line
  Pose T_map_scan = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of a right perturbation, translation then rotation
  PlaceScore score;
  double margin = 0.0;  ///< of the score over that of the best other place; 1 without any
  double lead = 0.0;    ///< the same in standard deviations of chance; infinite without any
  std::vector<LocalizationCandidate> candidates;  ///< distinct places, best first
};

/// Says where in a map a scan was taken, or that it cannot (paper 3.4): candidates from the map's
/// descriptors and from a search over its structure, each refined by NDT, judged by how its
/// surfaces fit, and accepted only when one place fits well and no other does. Keeps a reference to
/// the map. Const methods are thread-safe.
class GlobalLocalizer {
 public:
  GlobalLocalizer(const RelocalizeConfig& config, const PriorMap& map)
      : config_(config), map_(map), registration_(config.ndt) {}

  LocalizationResult Locate(const LocalizationQuery& query) const;

 private:
  struct Scan;
  std::vector<LocalizationCandidate> Propose(const LocalizationQuery& query,
                                             const Scan& scan) const;
  PoseWindow WindowFor(const LocalizationQuery& query, const Scan& scan) const;
  std::vector<LocalizationCandidate> ProposeByDescriptors(const Scan& scan) const;
  void FollowUp(const Scan& scan, std::vector<LocalizationCandidate>& candidates) const;
  void Measure(const Scan& scan, LocalizationResult& result) const;
  std::string WhyNot(const LocalizationResult& result, double min_fit) const;

  RelocalizeConfig config_;
  const PriorMap& map_;
  NdtRegistration registration_;
};

}  // namespace hv::relocalize
