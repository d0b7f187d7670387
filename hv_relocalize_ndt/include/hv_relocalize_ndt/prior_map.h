#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hv_core/map_folder.h"
#include "hv_loop_btc/btc_database.h"
#include "hv_loop_btc/saved_session.h"
#include "hv_relocalize_ndt/ndt_level.h"
#include "hv_relocalize_ndt/relocalize_config.h"
#include "hv_relocalize_ndt/structure.h"

namespace hv::relocalize {

/// A saved map, ready to be localised in: its cloud as Gaussians at every resolution, as structure
/// to search, and the descriptors and poses it came with. z points up. Immutable; const methods may
/// run concurrently.
class PriorMap {
 public:
  /// From a map folder, or a PCD or PLY file. The Gaussians are kept in the folder, in ndt.bin, for
  /// the next time. Throws InputError when the map is damaged or has no cloud.
  static PriorMap Load(const std::string& path, const RelocalizeConfig& config);

  /// From points [m].
  PriorMap(std::string name, std::vector<Eigen::Vector3f> points, const RelocalizeConfig& config);

  /// Where levels are kept; no path: nowhere.
  struct LevelFile {
    std::string path;
    std::string key;
  };

  const std::string& name() const { return name_; }
  const std::vector<Eigen::Vector3f>& points() const { return points_; }
  /// Coarse to fine.
  std::vector<const NdtLevel*> Levels() const;
  /// Of these, the ones for a pose that is known to a metre and some degrees.
  std::vector<const NdtLevel*> FineLevels() const;
  /// Those of the search and of the score.
  const NdtLevel& surfaces() const { return levels_.back(); }
  const StructureGrid& structure() const { return *structure_; }
  /// Keyframes and descriptors; none for a plain cloud.
  const std::optional<loop::SavedSession>& session() const { return session_; }

  /// Poses in the map at which the descriptors of its submaps resemble that of a scan, best first;
  /// none for a map without descriptors. `points` with the sensor at the origin [m], `up` against
  /// gravity.
  std::vector<Pose> PlacesLike(const std::vector<Eigen::Vector3f>& points,
                               const Eigen::Vector3d& up) const;

 private:
  std::string name_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<NdtLevel> levels_;  ///< of the alignment, coarse to fine, then the surfaces
  std::unique_ptr<StructureGrid> structure_;
  PriorMap(std::string name, std::vector<Eigen::Vector3f> points, const RelocalizeConfig& config,
           const LevelFile& file);
  void UseSession(loop::SavedSession session, const loop::BtcConfig& config);

  RelocalizeConfig config_;
  std::optional<loop::SavedSession> session_;
  loop::BtcConfig descriptor_config_;  ///< that the map was made with
  std::unique_ptr<loop::BtcDatabase> descriptors_;
  std::vector<Pose> T_map_submap_;  ///< of each descriptor
};

}  // namespace hv::relocalize
