#include "hv_replay/error_report.h"

#include <cstdarg>
#include <cstdio>

#include "hv_core/angles.h"
#include "hv_replay/console.h"

namespace hv::replay {
namespace {

__attribute__((format(printf, 1, 2))) std::string Format(const char* format, ...) {
  char text[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof(text), format, arguments);
  va_end(arguments);
  return text;
}

std::string Cell(double value) { return Format("%10.4f", value); }

std::string Row(const std::string& label, const Statistics& statistics, bool strong, bool colour) {
  const std::string name = Format("%-20s", label.c_str());
  if (statistics.count == 0) {
    return name + Paint("  path too short", Colour::kDim, colour) + "\n";
  }
  return Paint(name, strong ? Colour::kBold : Colour::kPlain, colour) + Cell(statistics.max) +
         Cell(statistics.mean) + Cell(statistics.median) +
         Paint(Cell(statistics.rmse), strong ? Colour::kGreen : Colour::kPlain, colour) +
         Cell(statistics.std) + "\n";
}

std::string LengthLabel(const char* what, double length_m, const char* unit) {
  return Format("%s %g m [%s]", what, length_m, unit);
}

JsonObject StatisticsJson(const Statistics& statistics) {
  JsonObject json;
  json.AddCount("count", statistics.count);
  json.Add("max", statistics.max).Add("mean", statistics.mean).Add("median", statistics.median);
  json.Add("rmse", statistics.rmse).Add("std", statistics.std);
  return json;
}

}  // namespace

std::string ErrorTable(const TrajectoryError& error, Alignment alignment, bool colour) {
  const Pose& aligned = error.T_reference_estimate;
  std::string text =
      Format("matched %zu poses (reference %zu, estimate %zu) over %.1f s and %.1f m\n",
             error.matched.size(), error.reference_poses, error.estimate_poses, error.duration_s,
             error.path_length_m);
  text += Format("alignment %s: rotated %.3f deg, moved %.3f m\n\n", ToString(alignment).c_str(),
                 kDegreesPerRadian * RotationDistance(aligned, Pose::Identity()),
                 aligned.translation().norm());
  text += Paint(Format("%-20s%10s%10s%10s%10s%10s\n", "", "Max", "Mean", "Median", "RMSE", "Std"),
                Colour::kDim, colour);
  text += Row("APE [m]", error.translation, true, colour);
  text += Row("  horizontal [m]", error.horizontal, false, colour);
  text += Row("  vertical [m]", error.vertical, false, colour);
  text += Row("rotation [deg]", error.rotation, true, colour);
  for (const RelativeError& relative : error.relative) {
    text += Row(LengthLabel("RPE", relative.length_m, "m"), relative.translation, false, colour);
    text += Row(LengthLabel("RPE", relative.length_m, "deg"), relative.rotation, false, colour);
  }
  text += Format("\nRMSE along x %.4f, y %.4f, z %.4f m\n", error.axis_rmse.x(),
                 error.axis_rmse.y(), error.axis_rmse.z());
  return text;
}

JsonObject ErrorJson(const TrajectoryError& error, Alignment alignment) {
  JsonObject json;
  json.Add("alignment", ToString(alignment));
  json.AddCount("matched", error.matched.size());
  json.AddCount("reference_poses", error.reference_poses);
  json.AddCount("estimate_poses", error.estimate_poses);
  json.Add("duration_s", error.duration_s).Add("path_length_m", error.path_length_m);
  json.Add("ape_m", StatisticsJson(error.translation));
  json.Add("horizontal_m", StatisticsJson(error.horizontal));
  json.Add("vertical_m", StatisticsJson(error.vertical));
  json.Add("rotation_deg", StatisticsJson(error.rotation));
  const Eigen::Vector3d& axes = error.axis_rmse;
  json.Add("axis_rmse_m", std::vector<double>{axes.x(), axes.y(), axes.z()});
  std::vector<JsonObject> relative_errors;
  for (const RelativeError& relative : error.relative) {
    JsonObject entry;
    entry.Add("length_m", relative.length_m);
    entry.Add("translation_m", StatisticsJson(relative.translation));
    entry.Add("rotation_deg", StatisticsJson(relative.rotation));
    relative_errors.push_back(entry);
  }
  json.Add("rpe", relative_errors);
  return json;
}

}  // namespace hv::replay
