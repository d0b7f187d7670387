#pragma once

#include <string>
#include <vector>

namespace hv::replay {

/// Points (x, y); those that are not finite are left out.
struct NamedCurve {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
};

/// One diagram.
struct CurvePanel {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<NamedCurve> curves;
};

/// Reads diagrams from a CSV file with the header `panel,curve,x,y`, in the order in which panels
/// and curves first appear; a panel's name is its title. Throws InputError, naming the line.
std::vector<CurvePanel> ReadCurvePanels(const std::string& path);

/// Draws diagrams below each other. The format follows from the ending of `path`. Throws InputError
/// when it cannot be written.
void PlotCurves(const std::vector<CurvePanel>& panels, const std::string& title,
                const std::string& path);

}  // namespace hv::replay
