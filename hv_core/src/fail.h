#pragma once

#include <cstring>
#include <string>

#include "hv_core/error.h"
#include "hv_core/one_line.h"

namespace hv {

/// Throws InputError of one line: what is wrong, and in which file or text.
[[noreturn]] inline void Fail(const std::string& source, const std::string& what) {
  throw InputError(OneLine(source + ": " + what));
}

/// The same with the reason that the system gives.
[[noreturn]] inline void Fail(const std::string& path, const std::string& what, int error) {
  Fail(path, what + " (" + std::strerror(error) + ")");
}

}  // namespace hv
