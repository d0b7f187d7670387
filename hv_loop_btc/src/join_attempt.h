#pragma once

#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "hv_loop_btc/pose_graph.h"
#include "hv_loop_btc/session_join.h"
#include "session_search.h"

namespace hv::loop {

/// One attempt to find the place of a session in a map.
class JoinAttempt {
 public:
  /// References are kept. The ids of `added` follow those of `map`.
  JoinAttempt(const LoopConfig& config, const SavedSession& map, const SavedSession& added,
              const SessionJoin::Progress& progress);

  /// To be called once.
  SessionJoinResult Run();

  /// Both sessions as one, after a Run() that joined them.
  SavedSession Joined() const;

 private:
  void FindAnywhere();
  void FindNearby();
  void Vote(const SubmapRecord& record, SessionSearch& search, LoopVote& vote,
            double uncertainty_m);
  void Report(double share) const;
  bool IsNear(const SubmapRecord& record, double distance_m) const;
  std::set<std::uint32_t> Located() const;
  int CommonTriangles() const;
  std::string WhyNot(const SessionJoinResult& result) const;
  SessionJoinResult Outcome() const;

  const LoopConfig& config_;
  const SavedSession& map_;
  const SavedSession& added_;
  const SessionJoin::Progress& progress_;
  PoseGraph graph_;
  std::size_t own_edges_ = 0;               ///< the edges behind are the loops between both
  std::vector<int> triangles_;              ///< that these loops have in common
  std::size_t fitting_ = 0;                 ///< submaps that fit somewhere in the map
  std::vector<BtcDescriptor> descriptors_;  ///< of the added session, at the scale of the map
};

}  // namespace hv::loop
