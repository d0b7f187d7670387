#include "bag_findings.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include <Eigen/Geometry>

#include "hv_core/angles.h"
#include "hv_core/so3.h"
#include "hv_replay/console.h"

namespace hv::replay {
namespace {

/// Correlation of rotations below which nothing is concluded from them.
constexpr double kUsableCorrelation = 0.8;
/// Offsets beyond this are worth correcting [s].
constexpr double kTolerableOffset = 0.005;

__attribute__((format(printf, 1, 2))) std::string Format(const char* format, ...) {
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof(text), format, arguments);
  va_end(arguments);
  return text;
}

/// The quaternion of a rotation whose w is not negative.
Eigen::Quaterniond Upright(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  return q;
}

/// Appends findings.
class Judge {
 public:
  Judge(const lio::SystemConfig& config, const BagCheckOptions& options, BagCheck& check)
      : config_(config), options_(options), check_(check) {}

  void Run() {
    JudgeStream("points", check_.points);
    JudgeClouds();
    JudgePointTime();
    if (check_.imu.count == 0) {
      Add(CheckLevel::kWarning, "imu", "none: only odometry with use_imu: false can run");
      return;
    }
    JudgeStream("imu", check_.imu);
    JudgeImuRate();
    JudgeAcceleration();
    JudgeOverlap();
    JudgeGyro();
    JudgeOffset();
    JudgeExtrinsic();
  }

 private:
  void Add(CheckLevel level, const std::string& name, const std::string& text) {
    check_.items.push_back({level, name, text});
  }
  void Warn(const std::string& name, const std::string& text) {
    Add(CheckLevel::kWarning, name, text);
  }
  void Good(const std::string& name, const std::string& text) {
    Add(CheckLevel::kGood, name, text);
  }

  const RotationMatch* Match() const {
    const bool usable = check_.rotation && check_.rotation->correlation > kUsableCorrelation;
    return usable ? &*check_.rotation : nullptr;
  }

  void JudgeStream(const std::string& name, const StreamFigures& stream);
  void JudgeClouds();
  void JudgePointTime();
  void JudgeImuRate();
  void JudgeAcceleration();
  void JudgeOverlap();
  void JudgeGyro();
  void JudgeOffset();
  void JudgeExtrinsic();

  const lio::SystemConfig& config_;
  const BagCheckOptions& options_;
  BagCheck& check_;
};

void Judge::JudgeStream(const std::string& name, const StreamFigures& stream) {
  Good(name, Format("%zu messages at %.1f Hz, arriving %.1f ms after their stamp", stream.count,
                    stream.rate_hz, 1e3 * stream.latency_s));
  if (stream.gaps > 0) {
    Warn(name, Format("%zu gaps, the longest %.3f s at %.1f s after the start", stream.gaps,
                      stream.longest_gap_s, stream.longest_gap_at_s));
  }
  if (stream.unsorted > 0) {
    Warn(name, Format("%zu stamps step back, by up to %.3f s", stream.unsorted,
                      stream.longest_step_back_s));
  }
  if (stream.duplicates > 0) Warn(name, Format("%zu stamps occur twice", stream.duplicates));
}

void Judge::JudgeClouds() {
  const CloudFigures& cloud = check_.cloud;
  Good("fields", cloud.fields + " in frame '" + cloud.frame_id + "'");
  if (cloud.unusable > 0) {
    const bool all = cloud.unusable == check_.points.count;
    Add(all ? CheckLevel::kError : CheckLevel::kWarning, "clouds",
        Format("%zu of %zu cannot be used: ", cloud.unusable, check_.points.count) +
            cloud.first_error);
    if (all) return;
  }
  const std::string text =
      Format("%.0f points a scan on %zu rings, %.0f %% finite and between %g and %g m",
             cloud.points_per_scan, cloud.rings, 100.0 * cloud.kept_share,
             config_.points.min_range_m, config_.points.max_range_m);
  const bool few = cloud.points_per_scan * cloud.kept_share < 500.0;
  Add(few ? CheckLevel::kWarning : CheckLevel::kGood, "clouds", text);
}

void Judge::JudgePointTime() {
  const CloudFigures& cloud = check_.cloud;
  if (!cloud.time) {
    Warn("point time", "could not be judged (clouds too small or without plausible times)");
    return;
  }
  const bool doubtful = cloud.time->from_azimuth || cloud.time->other_clock;
  const std::string text = cloud.time->ToString();
  Add(doubtful ? CheckLevel::kWarning : CheckLevel::kGood, "point time",
      text.substr(text.find(": ") + 2));
  if (cloud.sweep_s > 1.2 * check_.points.median_interval_s && check_.points.count > 2) {
    Warn("point time", Format("a scan lasts %.3f s but the next follows after %.3f s: wrong unit?",
                              cloud.sweep_s, check_.points.median_interval_s));
  }
}

void Judge::JudgeImuRate() {
  if (check_.imu.rate_hz < 80.0) {
    Warn("imu",
         Format("%.0f Hz is slow; 100 Hz or more deskews fast motion better", check_.imu.rate_hz));
  }
  const ImuFigures& readings = check_.readings;
  if (readings.not_finite + readings.all_zero > 0) {
    Warn("imu", Format("%zu readings are not finite and %zu are all zero", readings.not_finite,
                       readings.all_zero));
  }
  Good("start", readings.starts_at_rest ? "at rest" : "in motion: the first seconds are less sure");
}

void Judge::JudgeAcceleration() {
  const double norm = check_.readings.acceleration_norm;
  if (!check_.readings.gravity_plausible) {
    Add(CheckLevel::kError, "gravity",
        Format("acceleration at quiet moments is %.3f, neither 9.81 m/s^2 nor 1 g", norm));
  } else if (check_.readings.in_g) {
    Warn("gravity",
         Format("%.3f: the accelerometer reads g, not m/s^2 (hv_lio converts it)", norm));
  } else {
    Good("gravity", Format("%.3f m/s^2", norm));
  }
}

void Judge::JudgeOverlap() {
  if (check_.covered_share > 0.9) {
    Good("overlap",
         Format("%.0f %% of the scans lie within the IMU's stamps", 100.0 * check_.covered_share));
    return;
  }
  Add(check_.covered_share < 0.1 ? CheckLevel::kError : CheckLevel::kWarning, "overlap",
      Format("only %.0f %% of the scans lie within the IMU's stamps: clocks differ or data miss",
             100.0 * check_.covered_share));
}

void Judge::JudgeGyro() {
  const RotationMatch* match = Match();
  const double peak = check_.readings.gyro_peak;
  if (match == nullptr) {
    if (peak > 20.0) {
      Warn("gyro", Format("peaks at %.1f: probably deg/s, rad/s are needed", peak));
    } else {
      Good("gyro", Format("peaks at %.2f rad/s", peak));
    }
  } else if (match->gyro_scale > 30.0 && match->gyro_scale < 90.0) {
    Add(CheckLevel::kError, "gyro",
        Format("reads %.1f times the rotation seen by the LiDAR: deg/s, rad/s are needed",
               match->gyro_scale));
  } else if (std::abs(match->gyro_scale - 1.0) > 0.1) {
    Warn("gyro", Format("reads %.2f times the rotation seen by the LiDAR", match->gyro_scale));
  } else {
    Good("gyro", Format("rad/s, %.3f times the rotation seen by the LiDAR", match->gyro_scale));
  }
}

void Judge::JudgeOffset() {
  const RotationMatch* match = Match();
  if (match == nullptr) {
    const char* why = check_.rotation ? "the rotations of both sensors do not match"
                                      : "too little rotation or too few scans";
    Add(check_.rotation ? CheckLevel::kWarning : CheckLevel::kGood, "time offset",
        Format("not measured: %s", why));
    return;
  }
  const double rest = match->offset_s - config_.odometry.lidar_time_offset_s;
  const std::string text = Format("add %+.1f ms to LiDAR stamps (correlation %.3f over %zu scans)",
                                  1e3 * match->offset_s, match->correlation, match->steps);
  if (std::abs(rest) <= kTolerableOffset) {
    Good("time offset", text);
  } else {
    Warn("time offset", text + Format("; set odometry.lidar_time_offset_s: %.4f", match->offset_s));
  }
}

void Judge::JudgeExtrinsic() {
  const RotationMatch* match = Match();
  if (match == nullptr) return;
  const Eigen::Quaterniond q = Upright(match->R_imu_lidar);
  const std::string measured =
      match->all_axes ? Format("measured T_imu_lidar rotation (xyzw) [%.4f, %.4f, %.4f, %.4f]",
                               q.x(), q.y(), q.z(), q.w())
                      : std::string("rotation about one axis only, so only that axis is compared");
  if (!options_.compare_extrinsic) {
    Good("extrinsic", measured);
    return;
  }
  const Eigen::Matrix3d configured = config_.odometry.extrinsic.T_imu_lidar().linear();
  const double direct = match->CorrelationWith(configured) / match->correlation;
  const double inverse = match->CorrelationWith(configured.transpose()) / match->correlation;
  const double angle =
      kDegreesPerRadian * so3::Log(configured.transpose() * match->R_imu_lidar).norm();
  const std::string off = match->all_axes ? Format("about %.1f deg off", angle)
                                          : Format("explains %.0f %%", 100.0 * direct);
  if (direct > 0.98) {
    Good("extrinsic", "configured rotation fits, " + off + "; " + measured);
  } else if (inverse > 0.98) {
    Add(CheckLevel::kError, "extrinsic",
        "configured rotation " + off +
            ": inverse given? T_imu_lidar turns LiDAR into IMU "
            "coordinates; " +
            measured);
  } else {
    Add(direct < 0.9 ? CheckLevel::kError : CheckLevel::kWarning, "extrinsic",
        "configured rotation " + off + "; " + measured);
  }
}

JsonObject StreamJson(const StreamFigures& stream) {
  JsonObject json;
  json.AddCount("count", stream.count).Add("rate_hz", stream.rate_hz);
  json.AddCount("gaps", stream.gaps).Add("longest_gap_s", stream.longest_gap_s);
  json.AddCount("unsorted", stream.unsorted).AddCount("duplicates", stream.duplicates);
  json.Add("latency_s", stream.latency_s);
  return json;
}

JsonObject RotationJson(const RotationMatch& match) {
  const Eigen::Quaterniond q = Upright(match.R_imu_lidar);
  JsonObject json;
  json.Add("lidar_time_offset_s", match.offset_s).Add("correlation", match.correlation);
  json.Add("gyro_scale", match.gyro_scale).Add("all_axes", match.all_axes);
  json.Add("rotation_xyzw", std::vector<double>{q.x(), q.y(), q.z(), q.w()});
  json.AddCount("scans", match.steps);
  return json;
}

const char* LevelName(CheckLevel level) {
  if (level == CheckLevel::kGood) return "good";
  return level == CheckLevel::kWarning ? "warning" : "error";
}

}  // namespace

void JudgeBag(const lio::SystemConfig& config, const BagCheckOptions& options, BagCheck& check) {
  Judge(config, options, check).Run();
}

std::string CheckReport(const BagCheck& check, bool colour) {
  std::string report;
  for (const CheckItem& item : check.items) {
    const bool good = item.level == CheckLevel::kGood;
    const bool warning = item.level == CheckLevel::kWarning;
    const Colour shade = good ? Colour::kGreen : warning ? Colour::kYellow : Colour::kRed;
    const char* mark = good ? "ok   " : warning ? "WARN " : "ERROR";
    report += Paint(mark, shade, colour) + "  " + Format("%-12s", item.name.c_str()) + "  " +
              item.text + "\n";
  }
  return report;
}

JsonObject CheckJson(const BagCheck& check) {
  std::vector<JsonObject> items;
  for (const CheckItem& item : check.items) {
    JsonObject entry;
    entry.Add("level", LevelName(item.level)).Add("name", item.name).Add("text", item.text);
    items.push_back(entry);
  }
  JsonObject json;
  json.Add("ok", !check.HasErrors()).Add("items", items);
  json.Add("points", StreamJson(check.points)).Add("imu", StreamJson(check.imu));
  json.Add("points_per_scan", check.cloud.points_per_scan).Add("sweep_s", check.cloud.sweep_s);
  json.Add("fields", check.cloud.fields);
  json.Add("acceleration_norm", check.readings.acceleration_norm);
  json.Add("acceleration_in_g", check.readings.in_g).Add("gyro_peak", check.readings.gyro_peak);
  if (check.rotation) json.Add("rotation", RotationJson(*check.rotation));
  return json;
}

}  // namespace hv::replay
