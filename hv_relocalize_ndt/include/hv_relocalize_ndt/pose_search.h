#pragma once

#include <cstddef>
#include <vector>

#include "hv_core/config.h"
#include "hv_core/se3.h"
#include "hv_relocalize_ndt/structure.h"

namespace hv::relocalize {

struct PoseSearchConfig {
  double cell_m = 0.5;
  int depth = 5;
  double max_range_m = 20.0;
  int max_cells = 150;
  double level_share = 0.2;
  int max_hypotheses = 8;
  double min_score = 0.3;
  double min_score_share = 0.85;
  double same_place_m = 1.5;
  double same_heading_deg = 15.0;
  int max_nodes = 400000;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Where poses are looked for: a box of positions and a sector of headings.
struct PoseWindow {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();   ///< of positions in the map [m]
  Eigen::Vector3d high = Eigen::Vector3d::Zero();  ///< [m]
  double yaw_rad = 0.0;                            ///< middle of the headings
  double yaw_range_rad = 0.0;                      ///< to either side; pi for all
};

/// A pose that a scan may have been taken at.
struct PoseHypothesis {
  Pose T_map_level = Pose::Identity();  ///< of the upright frame of the scan
  double score = 0.0;                   ///< share of the scan's structure that the map holds there
};

/// Finds the poses in a window at which the structure of a scan fits the map best, by branch and
/// bound over position and heading; the vertical is known. Exhaustive: what it returns are the best
/// poses of the window at the resolution of the grid, best first, at distinct places; none where
/// nothing resembles the scan.
class PoseSearch {
 public:
  PoseSearch(const PoseSearchConfig& config, const StructureGrid& grid)
      : config_(config), grid_(grid) {}

  std::vector<PoseHypothesis> Find(const std::vector<StructureCell>& scan,
                                   const PoseWindow& window) const;

 private:
  PoseSearchConfig config_;
  const StructureGrid& grid_;
};

}  // namespace hv::relocalize
