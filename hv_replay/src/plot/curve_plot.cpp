#include "hv_replay/curve_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "axes.h"
#include "canvas.h"
#include "hv_core/error.h"
#include "hv_core/file_io.h"

namespace hv::replay {
namespace {

using plot::Axes;
using plot::Canvas;
using plot::PixelRect;
using plot::Range;

constexpr int kPictureWidth = 1000;
constexpr int kTop = 60;
constexpr int kPanelHeight = 300;
/// Room around the curves for ticks, title and legend [px].
constexpr double kLeft = 90.0;
constexpr double kRight = 40.0;
constexpr double kAbove = 40.0;
constexpr double kBelow = 50.0;

NamedCurve Finite(const NamedCurve& curve) {
  NamedCurve finite{curve.name, {}, {}};
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) continue;
    finite.x.push_back(curve.x[i]);
    finite.y.push_back(curve.y[i]);
  }
  return finite;
}

/// With a little room, also when all values are the same.
Range Widened(const std::vector<double>& values) {
  const Range range = plot::RangeOf(values);
  const double margin = range.span() > 0.0 ? 0.05 * range.span() : 0.5;
  return {range.low - margin, range.high + margin};
}

/// The one whose `name` it is, appended when there is none.
template <typename Thing>
Thing& Named(std::string Thing::*name, const std::string& wanted, std::vector<Thing>& things) {
  const auto found = std::find_if(things.begin(), things.end(),
                                  [&](const Thing& thing) { return thing.*name == wanted; });
  if (found != things.end()) return *found;
  Thing thing;
  thing.*name = wanted;
  return things.emplace_back(std::move(thing));
}

bool AddRow(const std::string& line, std::vector<CurvePanel>& panels) {
  std::istringstream row(line);
  std::array<std::string, 2> names;
  for (std::string& name : names) std::getline(row, name, ',');
  std::string numbers;
  std::getline(row, numbers);
  double x = 0.0;
  double y = 0.0;
  char more = 0;
  if (std::sscanf(numbers.c_str(), "%lf,%lf%c", &x, &y, &more) != 2) return false;
  CurvePanel& panel = Named(&CurvePanel::title, names[0], panels);
  NamedCurve& curve = Named(&NamedCurve::name, names[1], panel.curves);
  curve.x.push_back(x);
  curve.y.push_back(y);
  return true;
}

void DrawPanel(Canvas& canvas, const CurvePanel& panel, const PixelRect& area) {
  std::vector<NamedCurve> curves;
  std::vector<double> x;
  std::vector<double> y;
  for (const NamedCurve& curve : panel.curves) {
    curves.push_back(Finite(curve));
    x.insert(x.end(), curves.back().x.begin(), curves.back().x.end());
    y.insert(y.end(), curves.back().y.begin(), curves.back().y.end());
  }
  Axes axes(canvas, area, plot::RangeOf(x), Widened(y));
  axes.DrawFrame({panel.title, panel.x_label, panel.y_label});
  std::vector<plot::LegendEntry> legend;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    axes.Curve(curves[k].x, curves[k].y, plot::SeriesColour(k), 2.0);
    legend.push_back({curves[k].name, plot::SeriesColour(k)});
  }
  axes.Legend(legend);
}

}  // namespace

std::vector<CurvePanel> ReadCurvePanels(const std::string& path) {
  std::istringstream lines(ReadFile(path));
  std::string line;
  std::getline(lines, line);
  if (line != "panel,curve,x,y") throw InputError(path + ": line 1: `panel,curve,x,y` is expected");
  std::vector<CurvePanel> panels;
  for (int number = 2; std::getline(lines, line); ++number) {
    if (!AddRow(line, panels)) {
      throw InputError(path + ": line " + std::to_string(number) +
                       ": two names and two numbers are expected");
    }
  }
  if (panels.empty()) throw InputError(path + ": holds no points");
  return panels;
}

void PlotCurves(const std::vector<CurvePanel>& panels, const std::string& title,
                const std::string& path) {
  Canvas canvas(kPictureWidth, kTop + kPanelHeight * static_cast<int>(panels.size()), plot::kWhite);
  canvas.Text({28.0, 40.0}, title, {22.0, plot::kTextColour, plot::TextAnchor::kLeft, true});
  double top = kTop;
  for (const CurvePanel& panel : panels) {
    DrawPanel(canvas, panel,
              {kLeft, top + kAbove, kPictureWidth - kRight, top + kPanelHeight - kBelow});
    top += kPanelHeight;
  }
  canvas.Save(path);
}

}  // namespace hv::replay
