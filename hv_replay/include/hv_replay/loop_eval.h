#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hv_loop_btc/loop_closer.h"

namespace hv::replay {

/// What the evaluation of loop closing is given.
struct LoopEvalInput {
  std::string poses;   ///< TUM file: poses of the frame of the clouds in a frame with z up
  std::string clouds;  ///< folder of PCD or PLY files, one a pose, in order of their names
  /// Place recognition alone: every place and heading is possible, and odometry says nothing.
  bool blind = false;
};

/// Figures of one evaluation.
struct LoopEvalSummary {
  std::size_t clouds = 0;
  std::size_t submaps = 0;
  std::size_t candidates = 0;
  std::size_t accepted = 0;
  std::vector<double> detect_ms;  ///< extraction and query, one a submap
};

/// Runs loop detection over clouds with poses and writes one row a candidate: those of loops.csv,
/// and the durations of its submap. Throws InputError.
LoopEvalSummary EvaluateLoops(const LoopEvalInput& input, const loop::LoopConfig& config,
                              const std::string& csv);

}  // namespace hv::replay
