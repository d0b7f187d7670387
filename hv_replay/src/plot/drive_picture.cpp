#include "hv_replay/drive_picture.h"

#include <algorithm>
#include <cmath>

#include "axes.h"
#include "canvas.h"
#include "hv_core/error.h"

namespace hv::replay {
namespace {

using plot::Axes;
using plot::Canvas;
using plot::PixelPoint;
using plot::PixelRect;
using plot::Range;
using plot::Rgb;

constexpr double kLongSide = 1500.0;
constexpr double kMargin = 80.0;
constexpr Rgb kWallColour = {60, 66, 78};
constexpr Rgb kFreeColour = {246, 247, 249};
constexpr Rgb kLineColour = {70, 120, 190};
constexpr Rgb kReachedColour = {40, 150, 80};
constexpr Rgb kFailedColour = {214, 40, 40};
constexpr Rgb kContactColour = {0, 0, 0};

/// The part of the grid that is known, in metres.
struct Extent {
  Range x = {INFINITY, -INFINITY};
  Range y = {INFINITY, -INFINITY};
};

Extent KnownExtent(const OccupancyGrid& map) {
  Extent extent;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.At(column, row) == OccupancyGrid::kUnknown) continue;
      const Eigen::Vector2d at = map.CenterOf({column, row});
      extent.x = {std::min(extent.x.low, at.x()), std::max(extent.x.high, at.x())};
      extent.y = {std::min(extent.y.low, at.y()), std::max(extent.y.high, at.y())};
    }
  }
  if (extent.x.low > extent.x.high) throw InputError("no cells of the map are known");
  return extent;
}

/// Cells of a row that are alike become one rectangle.
void DrawMap(Canvas& canvas, const Axes& axes, const OccupancyGrid& map) {
  const auto kind = [&map](int column, int row) {
    const std::int8_t cell = map.At(column, row);
    return cell == OccupancyGrid::kUnknown ? 0 : OccupancyGrid::IsOccupied(cell) ? 2 : 1;
  };
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width;) {
      int end = column + 1;
      while (end < map.width && kind(end, row) == kind(column, row)) ++end;
      if (const int which = kind(column, row); which > 0) {
        const Eigen::Vector2d low = map.origin + map.resolution_m * Eigen::Vector2d(column, row);
        const Eigen::Vector2d high = map.origin + map.resolution_m * Eigen::Vector2d(end, row + 1);
        const PixelPoint a = axes.ToPixel(low.x(), high.y());
        const PixelPoint b = axes.ToPixel(high.x(), low.y());
        canvas.Rectangle({a.x, a.y, b.x, b.y}, which == 2 ? kWallColour : kFreeColour);
      }
      column = end;
    }
  }
}

void DrawLine(Canvas& canvas, const Axes& axes, const DrivenLine& line) {
  std::vector<PixelPoint> pixels;
  for (const Eigen::Vector2d& point : line.points) {
    pixels.push_back(axes.ToPixel(point.x(), point.y()));
  }
  canvas.Polyline(pixels, line.failed ? kFailedColour : kLineColour, line.failed ? 2.5 : 1.5);
}

void DrawContacts(Canvas& canvas, const Axes& axes, const std::vector<Eigen::Vector2d>& contacts) {
  for (const Eigen::Vector2d& contact : contacts) {
    canvas.Disc(axes.ToPixel(contact.x(), contact.y()), 6.0, kContactColour);
  }
}

void DrawGoal(Canvas& canvas, const Axes& axes, const DrivenLine& line) {
  const PixelPoint goal = axes.ToPixel(line.goal.x(), line.goal.y());
  canvas.Disc(goal, line.failed ? 7.0 : 4.0, line.failed ? kFailedColour : kReachedColour);
  DrawContacts(canvas, axes, line.contacts);
}

/// Each piece in the colour of the share of the way that it lies at.
void DrawWay(Canvas& canvas, const Axes& axes, const std::vector<Eigen::Vector2d>& points) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(points.size());
    canvas.Line(axes.ToPixel(points[i - 1].x(), points[i - 1].y()),
                axes.ToPixel(points[i].x(), points[i].y()), plot::ScaleColour(share), 3.0);
  }
}

/// Draws the map, hands canvas and axes to `draw`, and saves the picture.
template <typename Draw>
void DrawOnMap(const OccupancyGrid& map, const std::string& title, const std::string& path,
               const Draw& draw) {
  const Extent extent = KnownExtent(map);
  const double scale = kLongSide / std::max({extent.x.span(), extent.y.span(), 1.0});
  const double width = std::max(scale * extent.x.span(), 600.0);
  const double height = std::max(scale * extent.y.span(), 300.0);
  Canvas canvas(static_cast<int>(width + 2.0 * kMargin), static_cast<int>(height + 2.0 * kMargin),
                plot::kWhite);
  const PixelRect area = {kMargin, kMargin, kMargin + width, kMargin + height};
  Axes axes = Axes::EqualScale(canvas, area, extent.x, extent.y);
  axes.DrawFrame({title, "x [m]", "y [m]"});
  DrawMap(canvas, axes, map);
  draw(canvas, axes);
  canvas.Save(path);
}

}  // namespace

void DrawDrives(const OccupancyGrid& map, const std::vector<DrivenLine>& lines,
                const std::string& title, const std::string& path) {
  DrawOnMap(map, title, path, [&lines](Canvas& canvas, Axes& axes) {
    for (const bool failed : {false, true}) {
      for (const DrivenLine& line : lines) {
        if (line.failed == failed) DrawLine(canvas, axes, line);
      }
    }
    for (const DrivenLine& line : lines) DrawGoal(canvas, axes, line);
    axes.Legend({{"driven", kLineColour},
                 {"reached", kReachedColour},
                 {"failed", kFailedColour},
                 {"collision", kContactColour}});
  });
}

void DrawExploration(const OccupancyGrid& map, const DrivenWay& way, const std::string& title,
                     const std::string& path) {
  DrawOnMap(map, title, path, [&way](Canvas& canvas, Axes& axes) {
    DrawWay(canvas, axes, way.points);
    DrawContacts(canvas, axes, way.contacts);
    if (way.points.empty()) return;
    const Eigen::Vector2d& start = way.points.front();
    const Eigen::Vector2d& end = way.points.back();
    axes.Marker(start.x(), start.y(), kReachedColour, "start");
    axes.Marker(end.x(), end.y(), kFailedColour, "end");
  });
}

}  // namespace hv::replay
