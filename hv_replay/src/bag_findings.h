#pragma once

#include "hv_replay/bag_check.h"

namespace hv::replay {

/// Turns the figures of `check` into findings, appended to `check.items`.
void JudgeBag(const lio::SystemConfig& config, const BagCheckOptions& options, BagCheck& check);

}  // namespace hv::replay
