#pragma once

#include <cstdint>
#include <string>

#include "hv_core/keyframe_store.h"
#include "hv_loop_btc/loop_closer.h"

namespace hv::loop {

/// First numbers that a new session may use.
struct SessionStart {
  std::uint32_t keyframe = 0;
  std::uint32_t segment = 0;
};

/// Loads a saved map so that the next keyframes continue it: graph and descriptors into `closer`,
/// which must be empty, the clouds of keyframes into `store`. Where the new session starts in the
/// map is unknown until loops join it. Throws InputError naming the file and its fault; every file
/// that is used is compared with its checksum.
SessionStart ContinueMap(const std::string& path, KeyframeStore& store, LoopCloser& closer);

}  // namespace hv::loop
