#include "hv_sim/live_config.h"

#include <algorithm>
#include <cmath>

namespace hv::sim {
namespace {

constexpr std::size_t kNumbersPerBox = 8;

bool IsBox(const TimedBox& box) {
  return box.center.allFinite() && box.size.allFinite() && box.size.minCoeff() > 0.0 &&
         box.from_s < box.until_s;
}

}  // namespace

std::vector<TimedBox> LiveConfig::timed_boxes() const {
  std::vector<TimedBox> result;
  for (std::size_t i = 0; i + kNumbersPerBox <= boxes.size(); i += kNumbersPerBox) {
    const double* v = &boxes[i];
    result.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6], v[7]});
  }
  return result;
}

void LiveConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("world", world, "name of a world or path of a map_server YAML");
  visitor.Field("seed", seed, "of clutter, start and noise");
  visitor.Field("world_seed", world_seed, "of clutter; below 0: as seed");
  visitor.Field("start", start, "x y z [m] yaw [deg] of the base at first; empty: anywhere free");
  visitor.Field("boxes", boxes,
                "obstacles, eight numbers each: centre x y z, size x y z [m], from, until [s]");
  visitor.Field("lidar_noise", lidar_noise, "range noise and mixed pixels");
  visitor.Field("people", people, "people walk around");
  visitor.Field("lidar_dropout", lidar_dropout, "probability that a return is lost");
  visitor.Field("point_share", point_share, "share of LiDAR columns fired, for speed");
  visitor.Field("truth_rate_hz", truth_rate_hz, "rate of the true state [Hz]; 0: none");
  visitor.Section("robot", robot, "drive and body");
  visitor.Section("camera", camera, "depth camera");
  visitor.Section("suite", suite, "LiDAR and IMU, and where they sit");
}

void LiveConfig::Validate(ConfigProblems& problems) const {
  robot.Validate(problems);
  camera.Validate(problems);
  suite.Validate(problems);
  problems.Require(start.empty() || start.size() == 4, "start", "needs x y z yaw, or nothing");
  const std::vector<TimedBox> timed = timed_boxes();
  problems.Require(boxes.size() % kNumbersPerBox == 0, "boxes", "needs eight numbers for each");
  problems.Require(std::all_of(timed.begin(), timed.end(), IsBox), "boxes",
                   "sizes must be positive, and from before until");
  problems.Require(lidar_dropout >= 0.0 && lidar_dropout <= 1.0, "lidar_dropout",
                   "must be in [0, 1]");
  problems.Require(point_share > 0.0 && point_share <= 1.0, "point_share", "must be in (0, 1]");
  problems.Require(truth_rate_hz >= 0.0 && truth_rate_hz <= suite.imu.rate_hz, "truth_rate_hz",
                   "must be in [0, suite.imu.rate_hz]");
}

}  // namespace hv::sim
