#pragma once

#include <functional>
#include <vector>

#include "hv_loop_btc/loop_closer.h"
#include "hv_loop_btc/saved_session.h"

namespace hv::loop {

/// Looks for the places of one session in another. Not thread-safe.
class SessionSearch {
 public:
  enum class Guess {
    kNone,  ///< any place and heading, gravity apart
    kNear   ///< near where the poses say
  };
  /// Pose in the map of a keyframe of either session.
  using Poses = std::function<Pose(std::uint32_t)>;

  /// References are kept. The ids of `added` follow those of `map`.
  SessionSearch(const LoopConfig& config, const SavedSession& map, const SavedSession& added,
                Guess guess);

  /// Places in the map that may be that of a submap of the added session; the reason of those that
  /// fit is empty.
  std::vector<LoopCandidate> Find(const SubmapRecord& record, const Poses& poses);

  double loop_distance_m() const { return detector_.loop_distance_m(); }
  double confirm_score() const { return detector_.confirm_score(); }
  /// Of the last Find(), made at the scale of the map.
  const BtcDescriptor& descriptor() const;

 private:
  bool InMap(std::uint32_t keyframe) const { return keyframe <= map_.graph.vertices.back().id; }
  std::vector<Point> PointsOf(std::uint32_t keyframe) const;

  const LoopConfig& config_;
  const SavedSession& map_;
  const SavedSession& added_;
  LoopDetector detector_;
};

}  // namespace hv::loop
