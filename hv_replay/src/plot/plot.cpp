#include "hv_replay/plot.h"

#include <algorithm>
#include <cstdio>

#include "axes.h"
#include "canvas.h"
#include "hv_core/error.h"

namespace hv::replay {
namespace {

using plot::Axes;
using plot::Canvas;
using plot::PixelRect;
using plot::Range;
using plot::Rgb;
using plot::TextAnchor;
using plot::TextStyle;

constexpr int kWidth = 1600;
constexpr int kHeight = 900;
constexpr PixelRect kTopView = {80.0, 110.0, 860.0, 840.0};

/// Columns of numbers to draw.
struct Columns {
  std::vector<double> time, x, y, z;

  void Add(double seconds, const Eigen::Vector3d& position) {
    time.push_back(seconds);
    x.push_back(position.x());
    y.push_back(position.y());
    z.push_back(position.z());
  }
};

void Append(const std::vector<double>& from, std::vector<double>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

/// All columns after each other, for ranges.
Columns Joined(const std::vector<Columns>& parts) {
  Columns all;
  for (const Columns& part : parts) {
    Append(part.time, all.time);
    Append(part.x, all.x);
    Append(part.y, all.y);
    Append(part.z, all.z);
  }
  return all;
}

/// A height range of at least a metre, so that millimetres do not look like mountains.
Range HeightRange(const std::vector<double>& heights) {
  Range range = plot::RangeOf(heights);
  const double missing = std::max(0.0, 1.0 - range.span());
  return {range.low - 0.5 * missing, range.high + 0.5 * missing};
}

void DrawTitle(Canvas& canvas, const std::string& title, const std::string& subtitle) {
  const TextStyle large = {22.0, plot::kTextColour, TextAnchor::kLeft, true};
  const TextStyle small = {14.0, plot::kFaintTextColour, TextAnchor::kRight, false};
  canvas.Text({28.0, 46.0}, title, large);
  canvas.Text({kWidth - 40.0, 46.0}, subtitle, small);
}

struct Style {
  Rgb colour;
  double thickness;
};

/// References are grey and broad, the others take the palette in turn.
std::vector<Style> StylesOf(const std::vector<NamedTrajectory>& trajectories) {
  std::vector<Style> styles;
  std::size_t next = 0;
  for (const NamedTrajectory& entry : trajectories) {
    styles.push_back(entry.is_reference ? Style{plot::kReferenceColour, 5.0}
                                        : Style{plot::SeriesColour(next++), 2.0});
  }
  return styles;
}

std::vector<Columns> ColumnsOf(const std::vector<NamedTrajectory>& trajectories) {
  std::optional<Time> start;
  for (const NamedTrajectory& entry : trajectories) {
    if (entry.trajectory.empty()) continue;
    const Time first = entry.trajectory.poses().front().stamp;
    start = start ? std::min(*start, first) : first;
  }
  if (!start) throw InputError("no poses to draw");
  std::vector<Columns> columns(trajectories.size());
  for (std::size_t k = 0; k < trajectories.size(); ++k) {
    for (const StampedPose& pose : trajectories[k].trajectory.poses()) {
      columns[k].Add(pose.stamp - *start, pose.pose.translation());
    }
  }
  return columns;
}

/// Indices with references first, so that they lie below.
std::vector<std::size_t> DrawingOrder(const std::vector<NamedTrajectory>& trajectories) {
  std::vector<std::size_t> order(trajectories.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_partition(order.begin(), order.end(),
                        [&](std::size_t k) { return trajectories[k].is_reference; });
  return order;
}

/// Short lengths in millimetres.
std::string LengthText(double metres) {
  char text[40];
  if (metres < 0.1) {
    std::snprintf(text, sizeof(text), "%.1f mm", 1e3 * metres);
  } else {
    std::snprintf(text, sizeof(text), "%.3f m", metres);
  }
  return text;
}

std::string Summary(const TrajectoryError& error) {
  char text[120];
  std::snprintf(text, sizeof(text), "%.0f m in %.0f s, %zu poses   APE RMSE ", error.path_length_m,
                error.duration_s, error.matched.size());
  return text + LengthText(error.translation.rmse) + ", max " + LengthText(error.translation.max);
}

void DrawColourBar(Canvas& canvas, double top_value) {
  const PixelRect bar = {kTopView.right - 190.0, 74.0, kTopView.right - 40.0, 84.0};
  for (double x = bar.left; x < bar.right; x += 1.0) {
    const double share = (x - bar.left) / bar.width();
    canvas.Rectangle({x, bar.top, x + 1.0, bar.bottom}, plot::ScaleColour(share));
  }
  const TextStyle left = {12.0, plot::kFaintTextColour, TextAnchor::kRight, false};
  const TextStyle right = {12.0, plot::kFaintTextColour, TextAnchor::kLeft, false};
  canvas.Text({bar.left - 8.0, bar.bottom - 0.5}, "error 0", left);
  canvas.Text({bar.right + 8.0, bar.bottom - 0.5}, LengthText(top_value), right);
}

/// The matched poses and errors of a comparison as columns.
struct Comparison {
  Columns reference, estimate;
  std::vector<double> translation, rotation;

  explicit Comparison(const TrajectoryError& error) {
    for (const MatchedPose& match : error.matched) {
      const double seconds = match.stamp - error.matched.front().stamp;
      reference.Add(seconds, match.reference.translation());
      estimate.Add(seconds, match.estimate.translation());
      translation.push_back(match.translation_error);
      rotation.push_back(match.rotation_error);
    }
  }
};

void DrawTopView(Canvas& canvas, const Comparison& data, const TrajectoryError& error) {
  const Columns all = Joined({data.reference, data.estimate});
  Axes axes = Axes::EqualScale(canvas, kTopView, plot::RangeOf(all.x), plot::RangeOf(all.y));
  axes.DrawFrame({"Seen from above", "x [m]", "y [m]"});
  axes.Curve(data.reference.x, data.reference.y, plot::kReferenceColour, 6.0);
  const double top = std::max(error.translation.max, 1e-9);
  std::vector<double> shade;
  for (const double value : data.translation) shade.push_back(value / top);
  axes.ShadedCurve(data.estimate.x, data.estimate.y, shade, 2.5);
  axes.Marker(data.reference.x.front(), data.reference.y.front(), plot::SeriesColour(2), "start");
  DrawColourBar(canvas, top);
}

void DrawHeights(Canvas& canvas, const Comparison& data) {
  const Columns all = Joined({data.reference, data.estimate});
  const PixelRect area = {960.0, 110.0, 1560.0, 320.0};
  Axes axes(canvas, area, plot::RangeOf(all.time), HeightRange(all.z));
  axes.DrawFrame({"Height", "time [s]", "[m]"});
  axes.Curve(data.reference.time, data.reference.z, plot::kReferenceColour, 5.0);
  axes.Curve(data.estimate.time, data.estimate.z, plot::SeriesColour(0), 2.0);
  axes.Legend({{"reference", plot::kReferenceColour}, {"estimate", plot::SeriesColour(0)}});
}

void DrawErrorCurve(Canvas& canvas, const PixelRect& area, const std::vector<double>& time,
                    const std::vector<double>& values, const Axes::Labels& labels, Rgb colour) {
  const Statistics statistics = Summarize(values);
  Axes axes(canvas, area, plot::RangeOf(time), {0.0, std::max(statistics.max, 1e-9)});
  axes.DrawFrame(labels);
  axes.Curve(time, values, colour, 1.5);
  axes.HorizontalLine(statistics.rmse, plot::kTextColour);
  char text[60];
  std::snprintf(text, sizeof(text), "RMSE %.3g", statistics.rmse);
  axes.Legend({{text, plot::kTextColour}});
}

}  // namespace

void PlotTrajectories(const std::vector<NamedTrajectory>& trajectories, const std::string& title,
                      const std::string& path) {
  const std::vector<Columns> columns = ColumnsOf(trajectories);
  const std::vector<Style> styles = StylesOf(trajectories);
  const Columns all = Joined(columns);
  Canvas canvas(kWidth, kHeight, plot::kWhite);
  DrawTitle(canvas, title, "");
  const PixelRect top_area = {80.0, 110.0, 1560.0, 640.0};
  const PixelRect side_area = {80.0, 720.0, 1560.0, 850.0};
  Axes top = Axes::EqualScale(canvas, top_area, plot::RangeOf(all.x), plot::RangeOf(all.y));
  Axes side(canvas, side_area, plot::RangeOf(all.time), HeightRange(all.z));
  top.DrawFrame({"Seen from above", "x [m]", "y [m]"});
  side.DrawFrame({"Height", "time [s]", "[m]"});
  std::vector<plot::LegendEntry> legend;
  for (const std::size_t k : DrawingOrder(trajectories)) {
    top.Curve(columns[k].x, columns[k].y, styles[k].colour, styles[k].thickness);
    side.Curve(columns[k].time, columns[k].z, styles[k].colour, styles[k].thickness);
    legend.push_back({trajectories[k].name, styles[k].colour});
  }
  top.Marker(all.x.front(), all.y.front(), plot::SeriesColour(2), "start");
  top.Legend(legend);
  canvas.Save(path);
}

void PlotError(const TrajectoryError& error, const std::string& title, const std::string& path) {
  if (error.matched.empty()) throw InputError("no matched poses to draw");
  const Comparison data(error);
  Canvas canvas(kWidth, kHeight, plot::kWhite);
  DrawTitle(canvas, title, Summary(error));
  DrawTopView(canvas, data, error);
  DrawHeights(canvas, data);
  DrawErrorCurve(canvas, {960.0, 400.0, 1560.0, 570.0}, data.estimate.time, data.translation,
                 {"Translation error", "time [s]", "[m]"}, plot::SeriesColour(0));
  DrawErrorCurve(canvas, {960.0, 660.0, 1560.0, 840.0}, data.estimate.time, data.rotation,
                 {"Rotation error", "time [s]", "[deg]"}, plot::SeriesColour(1));
  canvas.Save(path);
}

}  // namespace hv::replay
