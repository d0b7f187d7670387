#pragma once

#include <cstring>
#include <string>

#include "hv_core/error.h"

namespace hv {

/// Throws InputError: what is wrong, and in which file or text.
[[noreturn]] inline void Fail(const std::string& source, const std::string& what) {
  throw InputError(source + ": " + what);
}

/// The same with the reason that the system gives.
[[noreturn]] inline void Fail(const std::string& path, const std::string& what, int error) {
  Fail(path, what + " (" + std::strerror(error) + ")");
}

}  // namespace hv
