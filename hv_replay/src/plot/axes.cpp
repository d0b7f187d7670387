#include "axes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hv::replay::plot {
namespace {

constexpr double kTickTextHeight = 12.0;
constexpr double kLabelHeight = 13.0;
constexpr double kTitleHeight = 15.0;

/// A range widened so that it is not empty and leaves `margin` of its span on both sides.
Range Widened(Range range, double margin) {
  const double least = std::max(1e-6, 1e-9 * std::abs(range.low));
  if (range.span() < least) return {range.low - 0.5, range.high + 0.5};
  return {range.low - margin * range.span(), range.high + margin * range.span()};
}

double StepOf(const std::vector<double>& ticks) {
  return ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
}

}  // namespace

Range RangeOf(const std::vector<double>& values) {
  Range range = {INFINITY, -INFINITY};
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range.low <= range.high ? range : Range{0.0, 1.0};
}

std::vector<double> NiceTicks(const Range& range, int count) {
  const double rough = range.span() / std::max(1, count);
  if (!(rough > 0.0) || !std::isfinite(rough)) return {range.low};
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * 0.999) {
      step = factor * power;
      break;
    }
  }
  std::vector<double> ticks;
  const double first = std::ceil(range.low / step - 1e-9);
  for (double k = first; k * step <= range.high + 1e-9 * step; k += 1.0) ticks.push_back(k * step);
  return ticks;
}

std::string TickText(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  char text[64];
  const double clean = std::abs(value) < 1e-9 * step ? 0.0 : value;
  std::snprintf(text, sizeof(text), "%.*f", decimals, clean);
  return text;
}

Axes::Axes(Canvas& canvas, const PixelRect& area, Range x, Range y)
    : canvas_(canvas), area_(area), x_(Widened(x, 0.0)), y_(Widened(y, 0.06)) {}

Axes Axes::EqualScale(Canvas& canvas, const PixelRect& area, Range x, Range y) {
  x = Widened(x, 0.06);
  y = Widened(y, 0.06);
  const double scale = std::max(x.span() / area.width(), y.span() / area.height());
  const auto grown = [](Range range, double span) {
    const double middle = 0.5 * (range.low + range.high);
    return Range{middle - 0.5 * span, middle + 0.5 * span};
  };
  Axes axes(canvas, area, x, y);
  axes.x_ = grown(x, scale * area.width());
  axes.y_ = grown(y, scale * area.height());
  return axes;
}

PixelPoint Axes::ToPixel(double x, double y) const {
  return {area_.left + (x - x_.low) / x_.span() * area_.width(),
          area_.bottom - (y - y_.low) / y_.span() * area_.height()};
}

void Axes::DrawTicks() {
  const TextStyle below = {kTickTextHeight, kFaintTextColour, TextAnchor::kCentre, false};
  const TextStyle beside = {kTickTextHeight, kFaintTextColour, TextAnchor::kRight, false};
  const std::vector<double> x_ticks = NiceTicks(x_, static_cast<int>(area_.width() / 90.0));
  for (const double tick : x_ticks) {
    const double x = ToPixel(tick, y_.low).x;
    canvas_.Line({x, area_.top}, {x, area_.bottom}, kGridColour, 1.0);
    canvas_.Text({x, area_.bottom + 18.0}, TickText(tick, StepOf(x_ticks)), below);
  }
  const std::vector<double> y_ticks =
      NiceTicks(y_, std::max(4, static_cast<int>(area_.height() / 45.0)));
  for (const double tick : y_ticks) {
    const double y = ToPixel(x_.low, tick).y;
    canvas_.Line({area_.left, y}, {area_.right, y}, kGridColour, 1.0);
    canvas_.Text({area_.left - 8.0, y + 4.5}, TickText(tick, StepOf(y_ticks)), beside);
  }
}

void Axes::DrawFrame(const Labels& labels) {
  DrawTicks();
  canvas_.Line({area_.left, area_.bottom}, {area_.right, area_.bottom}, kAxisColour, 1.0);
  const TextStyle title = {kTitleHeight, kTextColour, TextAnchor::kLeft, true};
  const TextStyle unit = {kLabelHeight, kFaintTextColour, TextAnchor::kLeft, false};
  const double title_base = area_.top - 12.0;
  canvas_.Text({area_.left, title_base}, labels.title, title);
  const double after_title = canvas_.TextWidth(labels.title, title) + 10.0;
  canvas_.Text({area_.left + after_title, title_base}, labels.y, unit);
  const TextStyle x_label = {kLabelHeight, kFaintTextColour, TextAnchor::kRight, false};
  canvas_.Text({area_.right, area_.bottom + 36.0}, labels.x, x_label);
}

void Axes::Curve(const std::vector<double>& x, const std::vector<double>& y, Rgb colour,
                 double thickness) {
  std::vector<PixelPoint> points;
  points.reserve(x.size());
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (std::isfinite(x[i]) && std::isfinite(y[i])) points.push_back(ToPixel(x[i], y[i]));
  }
  canvas_.Clip({area_.left, area_.top - 2.0, area_.right + 2.0, area_.bottom + 2.0});
  canvas_.Polyline(points, colour, thickness);
  canvas_.Unclip();
}

void Axes::ShadedCurve(const std::vector<double>& x, const std::vector<double>& y,
                       const std::vector<double>& value, double thickness) {
  canvas_.Clip(area_);
  for (std::size_t i = 1; i < x.size(); ++i) {
    canvas_.Line(ToPixel(x[i - 1], y[i - 1]), ToPixel(x[i], y[i]), ScaleColour(value[i]),
                 thickness);
  }
  canvas_.Unclip();
}

void Axes::HorizontalLine(double y, Rgb colour) {
  const double height = ToPixel(x_.low, y).y;
  for (double left = area_.left; left < area_.right; left += 10.0) {
    canvas_.Line({left, height}, {std::min(left + 5.0, area_.right), height}, colour, 1.0);
  }
}

void Axes::Marker(double x, double y, Rgb colour, const std::string& label) {
  const PixelPoint at = ToPixel(x, y);
  canvas_.Disc(at, 6.0, kWhite);
  canvas_.Disc(at, 4.5, colour);
  const TextStyle style = {kTickTextHeight, kTextColour, TextAnchor::kLeft, false};
  canvas_.Text({at.x + 9.0, at.y - 6.0}, label, style);
}

void Axes::Legend(const std::vector<LegendEntry>& entries) {
  const TextStyle style = {kLabelHeight, kTextColour, TextAnchor::kLeft, false};
  double left = area_.right;
  for (const LegendEntry& entry : entries) left -= canvas_.TextWidth(entry.label, style) + 46.0;
  left += 14.0;
  const double base = area_.top - 12.0;
  for (const LegendEntry& entry : entries) {
    canvas_.Line({left, base - 4.5}, {left + 20.0, base - 4.5}, entry.colour, 3.0);
    canvas_.Text({left + 26.0, base}, entry.label, style);
    left += canvas_.TextWidth(entry.label, style) + 46.0;
  }
}

}  // namespace hv::replay::plot
