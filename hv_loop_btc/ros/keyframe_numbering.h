#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "hv_core/keyframe.h"
#include "hv_loop_btc/map_session.h"

namespace hv::loop {

/// Numbers the keyframes of a session. The odometry counts from 0 whenever it starts; ids and
/// segments of a map must grow, also when a saved map is continued or the odometry node is started
/// anew. Not thread-safe.
class KeyframeNumbering {
 public:
  explicit KeyframeNumbering(const SessionStart& start) : start_(start) {}

  enum class Verdict {
    kNext,       ///< goes on
    kRestarted,  ///< the odometry has started anew: a session of its own
    kRepeated    ///< the same keyframe again, not renumbered
  };

  /// Gives `keyframe` its id and segment in the map.
  Verdict Renumber(Keyframe& keyframe);

  /// Keyframes that the odometry has counted but that never came.
  std::size_t missing() const { return missing_; }

 private:
  struct Number {
    std::uint32_t id = 0;
    std::uint32_t segment = 0;
    Time stamp;
  };

  SessionStart start_;
  std::optional<Number> last_;  ///< as the odometry numbers
  std::size_t missing_ = 0;
};

}  // namespace hv::loop
