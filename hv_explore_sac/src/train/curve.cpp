#include "hv_explore_sac/train/curve.h"

#include <cstdio>
#include <sstream>

#include "hv_core/error.h"
#include "hv_core/file_io.h"

namespace hv::explore {
namespace {

constexpr const char* kHeader = "round,updates,states,loss,gain,travel,share";

}  // namespace

void WriteCurve(const std::vector<CurvePoint>& points, const std::string& path) {
  std::string text = std::string(kHeader) + "\n";
  for (const CurvePoint& point : points) {
    char row[160];
    std::snprintf(row, sizeof(row), "%d,%d,%d,%.9g,%.9g,%.9g,%.9g\n", point.round, point.updates,
                  point.states, point.loss, point.gain, point.travel, point.share);
    text += row;
  }
  WriteFile(path, {text});
}

std::vector<CurvePoint> ReadCurve(const std::string& path) {
  std::istringstream lines(ReadFile(path));
  std::string line;
  std::getline(lines, line);
  if (line != kHeader) throw InputError(path + ": line 1: not a curve of a training");
  std::vector<CurvePoint> points;
  while (std::getline(lines, line)) {
    CurvePoint point;
    const int fields =
        std::sscanf(line.c_str(), "%d,%d,%d,%lf,%lf,%lf,%lf", &point.round, &point.updates,
                    &point.states, &point.loss, &point.gain, &point.travel, &point.share);
    if (fields != 7) {
      throw InputError(path + ": line " + std::to_string(points.size() + 2) +
                       ": seven numbers are expected");
    }
    points.push_back(point);
  }
  return points;
}

}  // namespace hv::explore
