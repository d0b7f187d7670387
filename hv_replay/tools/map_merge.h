#pragma once

#include <functional>

#include <CLI/CLI.hpp>

/// Adds the command `merge` to hv_map. What is returned runs it and gives the exit status.
std::function<int()> AddMergeCommand(CLI::App& app);
