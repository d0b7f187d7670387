#pragma once

#include <stdexcept>
#include <string>

namespace hv {

/// Bad input from outside the program (file, configuration, command line): one line that says what
/// is wrong and where. Tools print it and exit non-zero; nodes refuse to start with it. Sensor data
/// never raises it while running.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hv
