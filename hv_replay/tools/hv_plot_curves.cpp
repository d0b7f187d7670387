#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "hv_replay/curve_plot.h"
#include "tool.h"

namespace {

struct Arguments {
  std::string curves;
  std::string title;
  std::string x_label;
  std::string y_label;
  std::string out;
};

void Declare(CLI::App& app, Arguments& arguments) {
  app.add_option("--curves", arguments.curves, "CSV with columns panel,curve,x,y")->required();
  app.add_option("--title", arguments.title, "of the picture");
  app.add_option("--x-label", arguments.x_label, "of every panel");
  app.add_option("--y-label", arguments.y_label, "of every panel");
  app.add_option("--out", arguments.out, "picture (.png)")->required();
}

int Run(const Arguments& arguments) {
  std::vector<hv::replay::CurvePanel> panels = hv::replay::ReadCurvePanels(arguments.curves);
  for (hv::replay::CurvePanel& panel : panels) {
    panel.x_label = arguments.x_label;
    panel.y_label = arguments.y_label;
  }
  hv::replay::PlotCurves(panels, arguments.title, arguments.out);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Draws curves from a table, a diagram for each panel.", "hv_plot_curves");
  Arguments arguments;
  Declare(app, arguments);
  return hv::replay::RunTool(app, argc, argv, [&arguments] { return Run(arguments); });
}
