#pragma once

#include <string>

#include "hv_core/error.h"
#include "hv_core/map_folder.h"

namespace hv::loop {

/// What a session needs of a saved map. Throws InputError that names the first missing part and
/// says that the map cannot be `purpose` ("joined", "continued").
inline void RequireParts(const MapFolder& map, const char* purpose) {
  const MapContents contents = map.contents();
  const auto require = [&](bool there, const char* what) {
    if (there) return;
    throw InputError(map.path() + ": cannot be " + purpose + ", the map has no " + what);
  };
  require(contents.keyframes, "keyframes");
  require(contents.graph, "pose graph");
  require(contents.descriptors, "descriptors");
}

}  // namespace hv::loop
