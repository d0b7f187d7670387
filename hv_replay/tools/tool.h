#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "hv_replay/console.h"

namespace hv::replay {

/// Parses the command line and runs the body of a tool. Wrong arguments and whatever the body
/// throws become one line on standard error and a non-zero exit status.
inline int RunTool(CLI::App& app, int argc, char** argv, const std::function<int()>& body) {
  app.failure_message([&app](const CLI::App*, const CLI::Error& error) {
    return app.get_name() + ": " + error.what() + " (--help lists the options)\n";
  });
  CLI11_PARSE(app, argc, argv);
  return RunTool(app.get_name(), body);
}

}  // namespace hv::replay
