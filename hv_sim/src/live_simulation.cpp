#include "hv_sim/live_simulation.h"

#include <cmath>
#include <utility>

#include "hv_core/angles.h"
#include "hv_core/error.h"
#include "hv_sim/imu_simulator.h"
#include "hv_sim/lidar.h"
#include "hv_sim/mesh_builder.h"
#include "hv_sim/start_pose.h"
#include "timed_scene.h"

namespace hv::sim {
namespace {

LiveConfig Valid(LiveConfig config) {
  ConfigProblems problems;
  config.Validate(problems);
  std::string lines;
  for (const std::string& line : problems.lines()) lines += (lines.empty() ? "" : "\n") + line;
  if (!lines.empty()) throw InputError(lines);
  return config;
}

LidarOptions MakeLidarOptions(const LiveConfig& config) {
  LidarOptions options;
  options.noise = config.lidar_noise;
  options.dropout = config.lidar_dropout;
  options.azimuth_keep = config.point_share;
  return options;
}

World WithPeople(World world, bool people) {
  if (!people) world.people.clear();
  return world;
}

/// Something that happens again and again.
struct Schedule {
  double first_s = 0.0;
  double period_s = 0.0;  ///< 0: never
  std::int64_t next = 0;

  double next_s() const { return first_s + static_cast<double>(next) * period_s; }
  bool Due(double time_s) const {
    constexpr double kRounding_s = 1e-9;
    return period_s > 0.0 && next_s() <= time_s + kRounding_s;
  }
};

double PeriodOf(double rate_hz) { return rate_hz > 0.0 ? 1.0 / rate_hz : 0.0; }

}  // namespace

struct LiveSimulation::Impl {
  Impl(World given_world, const LiveConfig& given_config)
      : config(Valid(given_config)),
        world(WithPeople(std::move(given_world), given_config.people)),
        seed(static_cast<std::uint32_t>(config.seed)),
        rig(MakeRig(config.suite)),
        T_base_camera(config.camera.mounting()),
        scene(world.mesh),
        body(config.robot, scene.scene(), world.people, seed),
        lidar(scene.scene(), world.people, MakeLidarModel(config.suite), MakeLidarOptions(config),
              seed),
        camera(config.camera, seed),
        imu(config.suite.imu, seed + 0x1A40U),
        sweeps{config.suite.first_scan_s, lidar.model().period(), 0},
        images{0.0, PeriodOf(config.camera.rate_hz), 0},
        truths{0.0, PeriodOf(config.truth_rate_hz), 0} {
    for (const TimedBox& box : config.timed_boxes()) scene.Add(box);
    UpdateScene(0.0);
    T_world_start = Start();
    body.Place(T_world_start);
    body.AdvanceTo(0.0);
  }

  Pose Start() const {
    if (config.start.empty()) return RandomStart(world, scene.scene(), config.robot, seed);
    const std::vector<double>& v = config.start;
    return Upright({v[0], v[1], v[2]}, v[3] * kRadiansPerDegree);
  }

  double time_s() const { return static_cast<double>(step) / config.suite.imu.rate_hz; }
  Time Stamp(double seconds) const {
    return Time::FromNanoseconds(Time::FromSeconds(config.suite.epoch_s).nanoseconds() +
                                 Time::FromSeconds(seconds).nanoseconds());
  }

  void UpdateScene(double seconds);
  void SendCollisions(const std::vector<Contact>& contacts, const Sink& sink);
  void SendImu(const Sink& sink);
  void SendTruth(const Sink& sink);
  void SendImages(const Sink& sink);
  void SendScans(const Sink& sink);

  LiveConfig config;
  World world;
  std::uint32_t seed;
  SensorRig rig;
  Pose T_base_camera;
  TimedScene scene;
  RobotBody body;
  LidarSimulator lidar;
  DepthCamera camera;
  ImuSimulator imu;
  Schedule sweeps;  ///< by their beginnings
  Schedule images;
  Schedule truths;
  Pose T_world_start = Pose::Identity();
  std::int64_t step = 0;
  int collisions = 0;
};

void LiveSimulation::Impl::UpdateScene(double seconds) {
  if (!scene.Update(seconds)) return;
  body.SetScene(scene.scene());
  lidar.SetScene(scene.scene());
}

void LiveSimulation::Impl::SendCollisions(const std::vector<Contact>& contacts, const Sink& sink) {
  for (const Contact& contact : contacts) {
    sink(Collision{Stamp(contact.time_s), contact, ++collisions});
  }
}

void LiveSimulation::Impl::SendImu(const Sink& sink) {
  const MotionState state = Attached(body.At(time_s()), rig.T_base_imu);
  sink(imu.Measure(IdealImu(Stamp(time_s()), state)));
}

void LiveSimulation::Impl::SendTruth(const Sink& sink) {
  for (; truths.Due(time_s()); ++truths.next) {
    sink(TrueState{Stamp(truths.next_s()), body.At(truths.next_s())});
  }
}

void LiveSimulation::Impl::SendImages(const Sink& sink) {
  for (; images.Due(time_s()); ++images.next) {
    const double seconds = images.next_s();
    const Pose T_world_camera = body.At(seconds).T_world_body * T_base_camera;
    DepthImage image = camera.Capture(*scene.scene(), world.people, T_world_camera, seconds);
    image.stamp = Stamp(seconds);
    sink(std::move(image));
  }
}

void LiveSimulation::Impl::SendScans(const Sink& sink) {
  for (; sweeps.Due(time_s() - sweeps.period_s); ++sweeps.next) {
    const double start_s = sweeps.next_s();
    Scan scan = lidar.Sweep(start_s, [this](double seconds) -> Pose {
      return body.At(seconds).T_world_body * rig.T_base_lidar;
    });
    scan.stamp = Stamp(start_s);
    sink(std::move(scan));
  }
}

LiveSimulation::LiveSimulation(World world, const LiveConfig& config)
    : impl_(std::make_unique<Impl>(std::move(world), config)) {}

LiveSimulation::~LiveSimulation() = default;

void LiveSimulation::Add(const TimedBox& box) { impl_->scene.Add(box); }

bool LiveSimulation::Command(const DriveCommand& command) { return impl_->body.Command(command); }

void LiveSimulation::Step(const Sink& sink) {
  ++impl_->step;
  impl_->UpdateScene(time_s());
  impl_->SendCollisions(impl_->body.AdvanceTo(time_s()), sink);
  impl_->SendImu(sink);
  impl_->SendTruth(sink);
  impl_->SendImages(sink);
  impl_->SendScans(sink);
}

void LiveSimulation::Place(const Pose& T_world_base) { impl_->body.Place(T_world_base); }

void LiveSimulation::Reset() { impl_->body.Place(impl_->T_world_start); }

double LiveSimulation::time_s() const { return impl_->time_s(); }
double LiveSimulation::step_s() const { return 1.0 / impl_->config.suite.imu.rate_hz; }
Time LiveSimulation::now() const { return impl_->Stamp(impl_->time_s()); }
MotionState LiveSimulation::State() const { return impl_->body.At(impl_->time_s()); }
int LiveSimulation::collisions() const { return impl_->collisions; }
const World& LiveSimulation::world() const { return impl_->world; }
const LiveConfig& LiveSimulation::config() const { return impl_->config; }

}  // namespace hv::sim
