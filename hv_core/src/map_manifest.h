#pragma once

#include <string>

#include "hv_core/map_folder.h"

namespace hv {

inline constexpr const char* kManifestName = "manifest.yaml";

std::string ManifestText(const MapManifest& manifest);

/// Checks version and sum of the text, migrates older versions. Throws InputError.
MapManifest ParseManifest(const std::string& text, const std::string& source);

/// True for files that a map consists of, the manifest included; `name` is relative to the folder.
bool IsMapFile(const std::string& name);

/// Id of "keyframes/000012.pcd"; false when `name` is no such name.
bool ParseKeyframeName(const std::string& name, std::uint32_t& id);

/// Where an interrupted replacement leaves the map that was at `path`.
std::string OldMapPathOf(const std::string& path);

}  // namespace hv
