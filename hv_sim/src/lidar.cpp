#include "hv_sim/lidar.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "hv_core/error.h"
#include "hv_core/so3.h"
#include "hv_sim/pedestrian.h"
#include "hv_sim/random.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::size_t kSubRays = 4;    ///< axis of the beam and three around it
constexpr double kPulseLength = 0.35;  ///< echoes closer than this merge [m]

/// A point of the footprint with its share of the energy.
struct SubRay {
  double right = 0.0;  ///< of the axis, in half divergences
  double up = 0.0;
  double share = 1.0;
};

constexpr std::array<SubRay, kSubRays> kFootprint = {SubRay{0.0, 0.0, 0.4}, SubRay{0.0, 0.7, 0.2},
                                                     SubRay{-0.606, -0.35, 0.2},
                                                     SubRay{0.606, -0.35, 0.2}};

struct Echo {
  double range = 0.0;   ///< [m]
  double energy = 0.0;  ///< share x reflectivity x cosine / range^2
  double cosine = 0.0;
  double reflectivity = 0.0;
};

Echo ToEcho(const Hit& hit, double share) {
  constexpr double kLeastCosine = 0.01;
  Echo echo;
  echo.range = static_cast<double>(hit.range);
  echo.cosine = std::max(kLeastCosine, static_cast<double>(hit.cosine));
  echo.reflectivity = static_cast<double>(hit.reflectivity);
  echo.energy = share * echo.reflectivity * echo.cosine / (echo.range * echo.range);
  return echo;
}

void Merge(const Echo& other, Echo& echo) {
  const double energy = echo.energy + other.energy;
  const double share = other.energy / energy;
  echo.range += share * (other.range - echo.range);
  echo.cosine += share * (other.cosine - echo.cosine);
  echo.reflectivity += share * (other.reflectivity - echo.reflectivity);
  echo.energy = energy;
}

/// The strongest echo of a beam: near hits melt into one (a mixed pixel), far ones compete.
Echo StrongestEcho(const Hit* hits, std::size_t count) {
  if (count == 1) return std::isfinite(hits->range) ? ToEcho(*hits, 1.0) : Echo{};
  std::array<Echo, kSubRays> echoes;  // nearest first
  std::size_t used = 0;
  for (std::size_t i = 0; i < count && i < kSubRays; ++i) {
    if (!std::isfinite(hits[i].range)) continue;
    std::size_t at = used++;
    echoes[at] = ToEcho(hits[i], kFootprint[i].share);
    for (; at > 0 && echoes[at].range < echoes[at - 1].range; --at) {
      std::swap(echoes[at], echoes[at - 1]);
    }
  }
  Echo best;
  for (std::size_t i = 0; i < used;) {
    Echo echo = echoes[i];
    const double first_range = echo.range;
    for (++i; i < used && echoes[i].range < first_range + kPulseLength; ++i) {
      Merge(echoes[i], echo);
    }
    if (echo.energy > best.energy) best = echo;
  }
  return best;
}

/// The pose during one firing column, exact at both ends. Between them, 50 us apart, the motion is
/// taken as a screw to second order, which is exact to nanometres.
class ColumnPose {
 public:
  ColumnPose(const Pose& begin, const Pose& end)
      : begin_(begin),
        turn_(so3::Log(begin.linear().transpose() * end.linear())),
        shift_(end.translation() - begin.translation()) {}

  Vector3d Origin(double share) const { return begin_.translation() + share * shift_; }
  Vector3d Rotate(double share, const Vector3d& direction) const {
    const Vector3d turn = share * turn_;
    const Vector3d first = turn.cross(direction);
    return begin_.linear() * (direction + first + 0.5 * turn.cross(first));
  }

 private:
  Pose begin_;
  Vector3d turn_;
  Vector3d shift_;
};

void CheckModel(const LidarModel& model) {
  const std::size_t channels = model.elevation.size();
  if (channels == 0 || model.azimuth_offset.size() != channels ||
      model.firing_delay.size() != channels || model.columns <= 0 || model.column_period <= 0.0) {
    throw InputError("LiDAR model '" + model.name +
                     "': needs columns and, for each channel, elevation, azimuth_offset and "
                     "firing_delay");
  }
}

}  // namespace

struct LidarSimulator::Impl {
  Impl(std::shared_ptr<const RayCaster> scene, LidarModel lidar_model, LidarOptions lidar_options,
       std::uint32_t key)
      : caster(std::move(scene)), model(std::move(lidar_model)), options(lidar_options), seed(key) {
    CheckModel(model);
  }

  std::size_t rays_per_beam() const { return options.noise ? kSubRays : 1; }
  bool Fires(int column) const {
    const auto count = [this](int columns) { return std::floor(columns * options.azimuth_keep); };
    return count(column + 1) > count(column);
  }

  void AppendBeam(int column, std::size_t channel, const ColumnPose& pose,
                  std::vector<Ray>& rays) const;
  std::vector<Pedestrian> NearbyPeople(double time_s, const Vector3d& from) const;
  bool Detect(const Echo& echo, Random& random) const;
  std::vector<Point> Column(int column, double start_s,
                            const std::function<Pose(double)>& T_world_lidar) const;

  std::shared_ptr<const RayCaster> caster;
  LidarModel model;
  LidarOptions options;
  std::uint32_t seed;
  std::vector<PersonPath> people;
};

void LidarSimulator::Impl::AppendBeam(int column, std::size_t channel, const ColumnPose& pose,
                                      std::vector<Ray>& rays) const {
  const double share = model.firing_delay[channel] / model.column_period;
  const Vector3f origin = pose.Origin(share).cast<float>();
  const Vector3d axis = model.Direction(column, channel);
  if (!options.noise) {
    rays.push_back({origin, pose.Rotate(share, axis).cast<float>()});
    return;
  }
  const Vector3d right = axis.cross(Vector3d::UnitZ()).normalized();
  const Vector3d up = right.cross(axis);
  const double spread = 0.5 * model.beam_divergence;
  for (const SubRay& sub : kFootprint) {
    const Vector3d direction = axis + spread * (sub.right * right + sub.up * up);
    rays.push_back({origin, pose.Rotate(share, direction.normalized()).cast<float>()});
  }
}

std::vector<Pedestrian> LidarSimulator::Impl::NearbyPeople(double time_s,
                                                           const Vector3d& from) const {
  constexpr double kVisible = 60.0;  // [m]
  std::vector<Pedestrian> nearby;
  for (const PersonPath& path : people) {
    const Pedestrian person = PedestrianAt(path, time_s);
    if ((person.center.cast<double>() - from).norm() < kVisible) nearby.push_back(person);
  }
  return nearby;
}

/// Weak echoes are lost: matt, far and grazing ones. With noise the limit is soft.
bool LidarSimulator::Impl::Detect(const Echo& echo, Random& random) const {
  if (echo.energy <= 0.0 || echo.range < model.min_range || echo.range > model.max_range) {
    return false;
  }
  if (options.dropout > 0.0 && random.Chance(options.dropout)) return false;
  const double limit = model.range_at_10_percent;
  const double signal = echo.energy * limit * limit / 0.1;
  constexpr double kSpeckle = 0.35;
  return signal > (options.noise ? random.Uniform(1.0 - kSpeckle, 1.0 + kSpeckle) : 1.0);
}

std::vector<Point> LidarSimulator::Impl::Column(
    int column, double start_s, const std::function<Pose(double)>& T_world_lidar) const {
  const double offset_s = column * model.column_period;
  const ColumnPose pose(T_world_lidar(start_s + offset_s),
                        T_world_lidar(start_s + offset_s + model.column_period));
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  const std::size_t channels = model.elevation.size();
  rays.reserve(channels * rays_per_beam());
  for (std::size_t channel = 0; channel < channels; ++channel) {
    AppendBeam(column, channel, pose, rays);
  }
  caster->Cast(rays, static_cast<float>(model.max_range + 1.0), hits);
  for (const Pedestrian& person : NearbyPeople(start_s + offset_s, pose.Origin(0.0))) {
    for (std::size_t i = 0; i < rays.size(); ++i) Intersect(person, rays[i], hits[i]);
  }

  const auto instant = static_cast<std::uint64_t>(std::llround(start_s * 1e9));
  Random random({seed, instant, static_cast<std::uint64_t>(column)});
  std::vector<Point> points;
  for (std::size_t channel = 0; channel < channels; ++channel) {
    const Echo echo = StrongestEcho(&hits[channel * rays_per_beam()], rays_per_beam());
    if (!Detect(echo, random)) continue;
    const double noise = options.noise ? model.range_sigma * random.Gauss() : 0.0;
    const Vector3f at = ((echo.range + noise) * model.Direction(column, channel)).cast<float>();
    const auto intensity = static_cast<float>(
        std::min(255.0, std::round(100.0 * echo.reflectivity * std::sqrt(echo.cosine))));
    points.push_back({at.x(), at.y(), at.z(), intensity,
                      static_cast<float>(offset_s + model.firing_delay[channel]),
                      static_cast<std::uint16_t>(channel)});
  }
  return points;
}

LidarSimulator::LidarSimulator(const World& world, LidarModel model, LidarOptions options,
                               std::uint32_t seed)
    : LidarSimulator(std::make_shared<RayCaster>(world.mesh), world.people, std::move(model),
                     options, seed) {}

LidarSimulator::LidarSimulator(std::shared_ptr<const RayCaster> scene,
                               std::vector<PersonPath> people, LidarModel model,
                               LidarOptions options, std::uint32_t seed)
    : impl_(std::make_unique<Impl>(std::move(scene), std::move(model), options, seed)) {
  if (options.people) impl_->people = std::move(people);
}

LidarSimulator::~LidarSimulator() = default;

void LidarSimulator::SetScene(std::shared_ptr<const RayCaster> scene) {
  impl_->caster = std::move(scene);
}

Scan LidarSimulator::Sweep(double start_s, const std::function<Pose(double)>& T_world_lidar) const {
  const int columns = impl_->model.columns;
  std::vector<std::vector<Point>> parts(static_cast<std::size_t>(columns));
  tbb::parallel_for(tbb::blocked_range<int>(0, columns, 16), [&](const auto& range) {
    for (int column = range.begin(); column < range.end(); ++column) {
      if (!impl_->Fires(column)) continue;
      parts[static_cast<std::size_t>(column)] = impl_->Column(column, start_s, T_world_lidar);
    }
  });
  Scan scan;
  scan.stamp = Time::FromSeconds(start_s);
  for (const std::vector<Point>& part : parts) {
    scan.points.insert(scan.points.end(), part.begin(), part.end());
  }
  // Firing order is time order.
  if (!scan.points.empty()) scan.duration = static_cast<double>(scan.points.back().time);
  return scan;
}

double LidarSimulator::DistanceToSurface(const Vector3d& point, double limit) const {
  return impl_->caster->Distance(point, limit);
}

const LidarModel& LidarSimulator::model() const { return impl_->model; }

}  // namespace hv::sim
