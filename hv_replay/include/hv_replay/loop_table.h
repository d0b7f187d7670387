#pragma once

#include <string>

#include "hv_loop_btc/loop_candidate.h"

namespace hv::replay {

/// Header of loops.csv: stamps [s] and keyframes of both submaps, T_match_query [m] and quaternion,
/// scores (0 to 1), whether the loop was accepted, and if not, why.
std::string LoopColumns();

/// One row under that header.
std::string LoopRow(const loop::LoopCandidate& loop);

}  // namespace hv::replay
