#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "hv_replay/slam_config.h"
#include "hv_sim/live_config.h"

/// What tools that drive a simulated robot are told alike.
struct SimulationArguments {
  hv::sim::LiveConfig simulation;
  std::string config;
  int threads = 0;
};

void DeclareSimulation(CLI::App& app, SimulationArguments& arguments);

/// The configuration file, with the threads of the command line. Throws InputError.
hv::replay::SlamConfig ReadSlamConfig(const SimulationArguments& arguments);

/// How many threads TBB may use: those of the command line, or all.
std::size_t LargestParallelism(const SimulationArguments& arguments);
