#include <cstdio>

#include <CLI/CLI.hpp>

#include "hv_replay/parameter_page.h"
#include "tool.h"

int main(int argc, char** argv) {
  CLI::App app("Prints every configuration key with default and meaning (docs/parameters.md).",
               "hv_parameters");
  return hv::replay::RunTool(app, argc, argv, [] {
    std::fputs(hv::replay::ParameterPage().c_str(), stdout);
    return 0;
  });
}
