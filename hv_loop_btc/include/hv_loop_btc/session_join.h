#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "hv_loop_btc/loop_closer.h"
#include "hv_loop_btc/saved_session.h"

namespace hv::loop {

/// Outcome of joining one session.
struct SessionJoinResult {
  bool joined = false;
  std::string reason;       ///< why not joined, one line
  std::size_t loops = 0;    ///< between the sessions, accepted
  std::size_t refused = 0;  ///< between the sessions, contradicted by the others
  int triangles = 0;        ///< in common, median over the accepted loops of the first search
  double residual_m = 0.0;  ///< of the accepted loops after optimisation, root mean square
  double residual_deg = 0.0;
};

/// Brings sessions recorded at different times into one map (methods section 2). The submaps of a
/// new session are looked for among those of the map without any guess; places that several
/// consecutive submaps agree on become loops, and the graph of all sessions is optimised with them.
/// Then the new session has its place, and further loops are looked for near it.
///
/// The map frame is that of the first session. Not thread-safe.
class SessionJoin {
 public:
  /// Called with the share of the work done, in [0, 1].
  using Progress = std::function<void(double)>;

  SessionJoin(const LoopConfig& config, SavedSession first);

  /// Joins `session`, or says why it cannot and leaves the map as it was. Throws InputError when
  /// clouds cannot be read.
  SessionJoinResult Add(const SavedSession& session, const Progress& progress = {});

  /// All that has been joined: ids of later sessions follow those of earlier ones.
  const SavedSession& session() const { return joined_; }

 private:
  LoopConfig config_;
  SavedSession joined_;
};

}  // namespace hv::loop
