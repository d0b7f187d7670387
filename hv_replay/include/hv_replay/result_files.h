#pragma once

#include <string>

namespace hv::replay {

/// Creates a folder for results, and those above it; returns its path. Throws InputError.
std::string CreateDirectory(const std::string& path);

/// Throws InputError when the file cannot be written.
void WriteText(const std::string& path, const std::string& text);

}  // namespace hv::replay
