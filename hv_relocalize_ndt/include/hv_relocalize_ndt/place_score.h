#pragma once

#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_core/se3.h"
#include "hv_loop_btc/view_image.h"
#include "hv_relocalize_ndt/ndt_level.h"

namespace hv::relocalize {

struct PlaceScoreConfig {
  double max_distance_m = 0.12;
  double max_range_m = 30.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// How well a scan fits a map at a pose.
struct PlaceScore {
  /// Share of the upright surfaces of the scan that lie on surfaces of the map; floors and
  /// ceilings, which fit anywhere, do not count. In [0, 1].
  double fit = 0.0;
  double overlap = 0.0;       ///< share of them with anything of the map around
  double seen_through = 0.0;  ///< share of the map's surfaces in view that the scan passes through
  double score() const;       ///< fit and seen_through in one number, 0 to 1
  double agreement() const;   ///< fit of what the map knows, 0 to 1; 0 where it knows nothing
};

/// Judges poses of one scan in a map. Keeps references. Const methods are thread-safe.
class PlaceJudge {
 public:
  /// `map_surfaces`, `scan_surfaces`: voxels of the same edge; `scan`: points in the frame of the
  /// scan, whose origin the sensor was at; `up`: against gravity in that frame.
  PlaceJudge(const PlaceScoreConfig& config, const NdtLevel& map_surfaces,
             const NdtLevel& scan_surfaces, const std::vector<Eigen::Vector3f>& scan,
             const Eigen::Vector3d& up);

  PlaceScore Judge(const Pose& T_map_scan) const;

  /// How much better one pose fits than another, in standard deviations of chance: only surfaces
  /// that fit at one of the two and not at the other tell them apart, and without a difference
  /// either is as likely (McNemar's test).
  double Lead(const Pose& T_map_scan, const Pose& T_map_scan_other) const;

 private:
  enum class Place { kUnknown, kOff, kOn };
  Place PlaceOf(const NdtVoxel& surface, const Eigen::Isometry3f& T_map_scan) const;

  const PlaceScoreConfig& config_;
  const NdtLevel& map_;
  loop::ViewImage view_;
  std::vector<NdtVoxel> upright_;  ///< of the scan
};

}  // namespace hv::relocalize
