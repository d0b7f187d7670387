#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "hv_core/map_folder.h"
#include "hv_core/pose_graph_data.h"
#include "hv_loop_btc/btc_descriptor.h"
#include "hv_loop_btc/submap_file.h"

namespace hv::loop {

/// What a map folder holds of one mapping session, or of several that were joined. Clouds stay on
/// disk.
struct SavedSession {
  std::string name;       ///< path of the map folder
  PoseGraphData graph;    ///< poses in the map frame of the session, z up; at least one vertex
  StoredSubmaps submaps;  ///< of keyframes of the graph, ids growing
  std::map<std::uint32_t, std::string> clouds;  ///< path of the PCD of every keyframe
};

/// Reads graph and submaps. Throws InputError when keyframes, graph or descriptors are missing,
/// damaged, or do not belong together. The clouds are not read: MapFolder::Verify() does.
SavedSession LoadSession(const MapFolder& map);

/// How the descriptors of a map were made, by the section `loop.btc` of the configuration in its
/// manifest; nothing when that cannot be read.
std::optional<BtcConfig> DescriptorConfigOf(const MapManifest& manifest);

/// The session with ids of its own: they follow those of `before`, and so does the way travelled.
SavedSession NumberedAfter(const SavedSession& before, SavedSession session);

}  // namespace hv::loop
