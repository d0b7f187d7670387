#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hv_relocalize_ndt/ndt_level.h"

namespace hv::relocalize {

/// Levels made of a map's cloud, kept in its folder so that they need not be made again. `key`
/// names what they were made of: a file with another key is as good as none.

/// Bytes with a magic number, a version, the key and a checksum.
std::string SerializeLevels(const std::vector<NdtLevel>& levels, const std::string& key);

/// Nothing when the bytes were made with another key or version. Throws InputError, naming
/// `source`, when they are damaged, whatever they are.
std::optional<std::vector<NdtLevel>> ParseLevels(const std::string& bytes, const std::string& key,
                                                 const std::string& source);

/// The levels that lie in the file; nothing when it is missing, out of date or damaged.
std::optional<std::vector<NdtLevel>> ReadLevels(const std::string& path, const std::string& key);

/// Replaces the file in one step. False when it cannot be written: the map may lie on a medium that
/// is read only.
bool WriteLevels(const std::string& path, const std::vector<NdtLevel>& levels,
                 const std::string& key);

}  // namespace hv::relocalize
