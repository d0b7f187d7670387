#pragma once

#include <optional>
#include <vector>

#include <CLI/CLI.hpp>

#include "hv_core/se3.h"

namespace hv::replay {

/// Declares --guess "x y z roll pitch yaw".
inline void DeclareGuess(CLI::App& app, std::vector<double>& values, const char* what) {
  app.add_option("--guess", values, what)
      ->expected(6)
      ->delimiter(' ')
      ->type_name("x y z roll pitch yaw [m, rad]");
}

inline std::optional<Pose> GuessFrom(const std::vector<double>& values) {
  if (values.size() != 6) return {};
  return MakePose(RotationFromRpy(values[3], values[4], values[5]),
                  {values[0], values[1], values[2]});
}

}  // namespace hv::replay
