#pragma once

#include <string>

namespace hv::replay {

/// The page docs/parameters.md: every key of the odometry's configuration with its default and
/// meaning, as Markdown.
std::string ParameterPage();

}  // namespace hv::replay
