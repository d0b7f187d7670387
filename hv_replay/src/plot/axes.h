#pragma once

#include <string>
#include <vector>

#include "canvas.h"

namespace hv::replay::plot {

/// An interval of data.
struct Range {
  double low = 0.0;
  double high = 1.0;
  double span() const { return high - low; }
};

/// Smallest range that holds the finite `values`; {0, 1} when there are none.
Range RangeOf(const std::vector<double>& values);

/// Round numbers (1, 2, 5 times a power of ten apart) inside `range`, about `count` of them.
std::vector<double> NiceTicks(const Range& range, int count);

/// Number with as many decimals as the tick distance `step` needs.
std::string TickText(double value, double step);

struct LegendEntry {
  std::string label;
  Rgb colour;
};

/// One diagram: maps data to pixels inside `area` and draws grid, ticks and labels. `area` is the
/// part for curves; ticks and title stand outside of it.
class Axes {
 public:
  struct Labels {
    std::string title;
    std::string x;
    std::string y;
  };

  Axes(Canvas& canvas, const PixelRect& area, Range x, Range y);
  /// With the same scale along both axes; ranges are widened to fill `area`.
  static Axes EqualScale(Canvas& canvas, const PixelRect& area, Range x, Range y);

  void DrawFrame(const Labels& labels);
  void Curve(const std::vector<double>& x, const std::vector<double>& y, Rgb colour,
             double thickness);
  /// Segment k is coloured by `value[k]` on ScaleColour.
  void ShadedCurve(const std::vector<double>& x, const std::vector<double>& y,
                   const std::vector<double>& value, double thickness);
  void HorizontalLine(double y, Rgb colour);
  void Marker(double x, double y, Rgb colour, const std::string& label);
  /// In the upper right corner above the area.
  void Legend(const std::vector<LegendEntry>& entries);

  PixelPoint ToPixel(double x, double y) const;

 private:
  void DrawTicks();

  Canvas& canvas_;
  PixelRect area_;
  Range x_;
  Range y_;
};

}  // namespace hv::replay::plot
