#pragma once

#include <string>

namespace hv {

/// `text` of an input as a message may quote it: control characters, line ends among them, are '?'.
std::string OneLine(std::string text);

}  // namespace hv
