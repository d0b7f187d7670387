#include "hv_sim/depth_camera.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hv_core/angles.h"
#include "hv_core/error.h"
#include "hv_sim/random.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

constexpr double kMillimetre = 1e-3;
constexpr double kLostCosine = 0.05;  ///< of a surface on which no pixel is matched
constexpr double kSureCosine = 0.20;  ///< and of one on which none is lost
constexpr double kJump = 0.1;         ///< between neighbours, share of the depth

double FocalLength(int pixels, double fov_deg) {
  return 0.5 * pixels / std::tan(0.5 * fov_deg * kRadiansPerDegree);
}

std::uint16_t Quantised(double depth_m) {
  return static_cast<std::uint16_t>(std::lround(std::min(depth_m, 65.0) / kMillimetre));
}

std::vector<Pedestrian> Nearby(const std::vector<PersonPath>& paths, double time_s,
                               const Vector3d& from, double reach_m) {
  std::vector<Pedestrian> nearby;
  for (const PersonPath& path : paths) {
    const Pedestrian person = PedestrianAt(path, time_s);
    const double distance = (person.center.cast<double>() - from).norm();
    if (distance < reach_m + static_cast<double>(kPedestrianRadius)) nearby.push_back(person);
  }
  return nearby;
}

}  // namespace

void DepthCameraConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("width", width, "columns of the image");
  visitor.Field("height", height, "rows of the image");
  visitor.Field("horizontal_fov_deg", horizontal_fov_deg, "angle of view, side to side [deg]");
  visitor.Field("vertical_fov_deg", vertical_fov_deg, "angle of view, top to bottom [deg]");
  visitor.Field("rate_hz", rate_hz, "images per second [Hz]; 0: none");
  visitor.Field("min_depth_m", min_depth_m, "nothing nearer is seen [m]");
  visitor.Field("max_depth_m", max_depth_m, "nothing further is seen [m]");
  visitor.Field("depth_noise", depth_noise, "standard deviation / depth^2 [1/m]");
  visitor.Field("edge_loss", edge_loss, "probability that a pixel at a jump of depth is lost");
  visitor.Field("noise", noise, "false: neither noise nor lost pixels");
  visitor.Field("T_base_camera", T_base_camera,
                "pose in the base frame, x along the view, z up: x y z qx qy qz qw");
}

void DepthCameraConfig::Validate(ConfigProblems& problems) const {
  const auto require = [&problems](bool condition, const char* key, const char* what) {
    problems.Require(condition, std::string("camera.") + key, what);
  };
  require(width >= 2 && width <= 4096, "width", "must be in [2, 4096]");
  require(height >= 2 && height <= 4096, "height", "must be in [2, 4096]");
  require(horizontal_fov_deg > 1.0 && horizontal_fov_deg < 170.0, "horizontal_fov_deg",
          "must be in (1, 170)");
  require(vertical_fov_deg > 1.0 && vertical_fov_deg < 170.0, "vertical_fov_deg",
          "must be in (1, 170)");
  require(rate_hz >= 0.0 && rate_hz <= 100.0, "rate_hz", "must be in [0, 100]");
  require(min_depth_m >= 0.0, "min_depth_m", "must not be negative");
  require(max_depth_m > min_depth_m && max_depth_m <= 65.0, "max_depth_m",
          "must be above min_depth_m and at most 65");
  require(depth_noise >= 0.0, "depth_noise", "must not be negative");
  require(edge_loss >= 0.0 && edge_loss <= 1.0, "edge_loss", "must be in [0, 1]");
  require(T_base_camera.size() == 7 &&
              std::abs(Eigen::Map<const Eigen::VectorXd>(T_base_camera.data(), 7).tail<4>().norm() -
                       1.0) < 1e-3,
          "T_base_camera", "needs x y z and a unit quaternion");
}

double DepthCameraConfig::fx() const { return FocalLength(width, horizontal_fov_deg); }
double DepthCameraConfig::fy() const { return FocalLength(height, vertical_fov_deg); }

Pose DepthCameraConfig::mounting() const {
  const std::vector<double>& v = T_base_camera;
  return MakePose(Eigen::Quaterniond(v[6], v[3], v[4], v[5]).normalized(),
                  Vector3d(v[0], v[1], v[2]));
}

Pose OpticalInCamera() {
  Eigen::Matrix3d rotation;
  rotation << 0.0, 0.0, 1.0,  //
      -1.0, 0.0, 0.0,         //
      0.0, -1.0, 0.0;
  return MakePose(rotation, Vector3d::Zero());
}

DepthCamera::DepthCamera(DepthCameraConfig config, std::uint32_t seed)
    : config_(std::move(config)), seed_(seed) {
  ConfigProblems problems;
  config_.Validate(problems);
  if (!problems.lines().empty()) throw InputError(problems.lines().front());
  for (int row = 0; row < config_.height; ++row) {
    for (int column = 0; column < config_.width; ++column) {
      const Vector3d direction((column - config_.cx()) / config_.fx(),
                               (row - config_.cy()) / config_.fy(), 1.0);
      directions_.push_back(direction.normalized());
    }
  }
}

/// The hits of a row, their ranges turned into depths.
std::vector<Hit> DepthCamera::CastRow(const RayCaster& scene, const std::vector<Pedestrian>& people,
                                      const Pose& T_world_optical, int row) const {
  const auto width = static_cast<std::size_t>(config_.width);
  const Vector3d* directions = &directions_[static_cast<std::size_t>(row) * width];
  const Eigen::Vector3f origin = T_world_optical.translation().cast<float>();
  std::vector<Ray> rays;
  rays.reserve(width);
  for (std::size_t i = 0; i < width; ++i) {
    rays.push_back({origin, (T_world_optical.linear() * directions[i]).cast<float>()});
  }
  const double reach = (config_.max_depth_m + 1.0) / std::min(directions[0].z(), 1.0);
  std::vector<Hit> hits;
  scene.Cast(rays, static_cast<float>(reach), hits);
  for (const Pedestrian& person : people) {
    for (std::size_t i = 0; i < width; ++i) Intersect(person, rays[i], hits[i]);
  }
  for (std::size_t i = 0; i < width; ++i) hits[i].range *= static_cast<float>(directions[i].z());
  return hits;
}

/// Probability that the pixel is not matched: on grazed surfaces, and beside what stands in front.
double DepthCamera::LossAt(const std::vector<Hit>& hits, int column, int row) const {
  const auto at = [&](int x, int y) -> const Hit& {
    const int clamped_x = std::clamp(x, 0, config_.width - 1);
    const int clamped_y = std::clamp(y, 0, config_.height - 1);
    return hits[static_cast<std::size_t>(clamped_y * config_.width + clamped_x)];
  };
  const Hit& hit = at(column, row);
  const double grazing =
      (kSureCosine - static_cast<double>(hit.cosine)) / (kSureCosine - kLostCosine);
  const auto jumps = [&](const Hit& other) {
    return std::abs(other.range - hit.range) > static_cast<float>(kJump) * hit.range;
  };
  const bool edge = jumps(at(column - 1, row)) || jumps(at(column + 1, row)) ||
                    jumps(at(column, row - 1)) || jumps(at(column, row + 1));
  return std::max(std::clamp(grazing, 0.0, 1.0), edge ? config_.edge_loss : 0.0);
}

DepthImage DepthCamera::Capture(const RayCaster& scene, const std::vector<PersonPath>& people,
                                const Pose& T_world_camera, double time_s) const {
  const Pose T_world_optical = T_world_camera * OpticalInCamera();
  const double reach = config_.max_depth_m / directions_.front().z();
  const std::vector<Pedestrian> nearby =
      Nearby(people, time_s, T_world_camera.translation(), reach);
  std::vector<Hit> hits(directions_.size());
  const auto width = static_cast<std::ptrdiff_t>(config_.width);
  tbb::parallel_for(tbb::blocked_range<int>(0, config_.height, 8), [&](const auto& rows) {
    for (int row = rows.begin(); row < rows.end(); ++row) {
      const std::vector<Hit> part = CastRow(scene, nearby, T_world_optical, row);
      std::copy(part.begin(), part.end(), hits.begin() + row * width);
    }
  });

  DepthImage image{Time::FromSeconds(time_s), config_.width, config_.height, {}};
  image.depth_mm.assign(hits.size(), 0);
  Random random({seed_, static_cast<std::uint64_t>(image.stamp.nanoseconds()), 0xD435U});
  for (std::size_t i = 0; i < hits.size(); ++i) {
    double depth_m = static_cast<double>(hits[i].range);
    if (!std::isfinite(depth_m)) continue;
    if (config_.noise) {
      const int pixel = static_cast<int>(i);
      if (random.Chance(LossAt(hits, pixel % config_.width, pixel / config_.width))) continue;
      depth_m += config_.depth_noise * depth_m * depth_m * random.Gauss();
    }
    if (depth_m < config_.min_depth_m || depth_m > config_.max_depth_m) continue;
    image.depth_mm[i] = Quantised(depth_m);
  }
  return image;
}

}  // namespace hv::sim
