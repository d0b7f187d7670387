#pragma once

#include <string>
#include <vector>

namespace hv::replay {

/// Paths of the PCD and PLY files of a folder, sorted. Throws InputError when it cannot be read.
std::vector<std::string> CloudFiles(const std::string& folder);

}  // namespace hv::replay
