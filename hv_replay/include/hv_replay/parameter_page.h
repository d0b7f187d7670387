#pragma once

#include <string>

namespace hv::replay {

/// The page docs/parameters.md: every key of the robot's configuration, then of that of a
/// training, with its default and meaning, as Markdown.
std::string ParameterPage();

}  // namespace hv::replay
