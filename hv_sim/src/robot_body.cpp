#include "hv_sim/robot_body.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "body_track.h"
#include "hv_core/angles.h"
#include "hv_core/error.h"
#include "hv_sim/ground.h"
#include "hv_sim/mesh_builder.h"
#include "hv_sim/random.h"

namespace hv::sim {
namespace {

using Eigen::Vector3d;

constexpr double kSkin_m = 0.003;       ///< gap that counts as touching
constexpr double kReleased_m = 0.02;    ///< a contact ends this far from where it began
constexpr double kReleased_rad = 0.15;  ///< or after this turn

struct Wave {
  int axis = 0;            ///< of a BodyControl
  double amplitude = 0.0;  ///< [m] or [rad]
  double rate = 0.0;       ///< [rad/s]
  double phase = 0.0;
};

/// Springs and tyres.
std::vector<Wave> Vibration(double scale, std::uint32_t seed) {
  std::vector<Wave> waves = {{2, 0.0002, 11.0, 0.0},
                             {2, 0.001, 2.6, 0.0},
                             {3, 0.15 * kRadiansPerDegree, 2.1, 0.0},
                             {4, 0.2 * kRadiansPerDegree, 2.9, 0.0},
                             {4, 0.03 * kRadiansPerDegree, 13.0, 0.0}};
  Random random({seed, 0x71B2U});
  for (Wave& wave : waves) {
    wave.amplitude *= scale;
    wave.rate *= 2.0 * M_PI * random.Uniform(0.95, 1.05);
    wave.phase = random.Uniform(0.0, 2.0 * M_PI);
  }
  return waves;
}

/// How much of the vibration there is: all from 0.3 m/s on.
double Liveliness(const DriveCommand& velocity) {
  return std::min(1.0, std::hypot(velocity.linear_mps, 0.3 * velocity.angular_rps) / 0.3);
}

/// `yaw` is not wrapped, so that the spline turns the short way.
BodyControl ControlAt(const Pose& T_world_base, double yaw) {
  const Eigen::Matrix3d& R = T_world_base.linear();
  BodyControl control;
  control << T_world_base.translation(), std::atan2(R(2, 1), R(2, 2)), -std::asin(R(2, 0)), yaw;
  return control;
}

bool Stands(const DriveState& before, const DriveState& after) {
  return before.position == after.position && before.yaw == after.yaw;
}

}  // namespace

void RobotBodyConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("drive", drive, "the wheels");
  visitor.Section("shape", shape, "the room that the robot takes up");
  visitor.Field("wheel_base_m", wheel_base_m, "between front and back wheels [m]");
  visitor.Field("vibration", vibration, "of a moving robot, 1: about 1 mm and 0.2 deg");
}

void RobotBodyConfig::Validate(ConfigProblems& problems) const {
  drive.Validate(problems);
  shape.Validate(problems);
  problems.Require(wheel_base_m > 0.0, "wheel_base_m", "must be positive");
  problems.Require(vibration >= 0.0, "vibration", "must not be negative");
}

struct RobotBody::Impl {
  Impl(const RobotBodyConfig& body_config, std::shared_ptr<const RayCaster> surroundings,
       std::vector<PersonPath> people, std::uint32_t seed)
      : config(body_config),
        scene(surroundings),
        checker(body_config.shape, std::move(surroundings), std::move(people)),
        drive(body_config.drive, seed),
        waves(Vibration(body_config.vibration, seed)) {
    track.Rest(BodyControl::Zero());
  }

  WheelLayout wheels() const { return {config.wheel_base_m, config.drive.track_m}; }

  void Place(const Pose& T_world_wanted);
  void Move();
  bool Released(const Clearance& now) const;
  std::optional<ContactKind> Blocked(const std::optional<Pose>& T_world_next,
                                     const Clearance& next) const;
  void Push(double time_s);

  RobotBodyConfig config;
  std::shared_ptr<const RayCaster> scene;
  CollisionChecker checker;
  DifferentialDrive drive;
  std::vector<Wave> waves;
  BodyTrack track;
  Pose T_world_base = Pose::Identity();  ///< of the newest control, without vibration
  Clearance clearance;
  std::optional<Contact> touching;
  std::deque<Contact> contacts;  ///< begun, but not reported yet
};

void RobotBody::Impl::Place(const Pose& T_world_wanted) {
  const Vector3d place = T_world_wanted.translation();
  const double yaw = std::atan2(T_world_wanted.linear()(1, 0), T_world_wanted.linear()(0, 0));
  const auto floor = FloorBelow(*scene, place + 0.1 * Vector3d::UnitZ(), 0.6);
  if (!floor) throw InputError("no floor under the robot");
  std::optional<Pose> T_world_ground = Upright({place.x(), place.y(), *floor}, yaw);
  // A tilted base has its wheels elsewhere: twice is enough on slopes that can be driven.
  for (int pass = 0; pass < 2 && T_world_ground; ++pass) {
    T_world_ground = OnGround(*scene, wheels(), *T_world_ground);
  }
  if (!T_world_ground) throw InputError("no floor under the wheels");
  T_world_base = *T_world_ground;
  drive.Place(place.head<2>(), yaw);
  track.Rest(ControlAt(T_world_base, yaw));
  const double time_s = static_cast<double>(track.newest()) * BodyTrack::kStep_s;
  clearance = checker.At(T_world_base, time_s, kReleased_m);
  touching.reset();
  contacts.clear();
}

/// Why the robot cannot be at its next place, if so. It may always get further away from things.
std::optional<ContactKind> RobotBody::Impl::Blocked(const std::optional<Pose>& T_world_next,
                                                    const Clearance& next) const {
  if (!T_world_next) return ContactKind::kEdge;
  const auto closer = [](double now_m, double next_m) {
    return next_m < kSkin_m && next_m <= now_m;
  };
  if (closer(clearance.static_m, next.static_m)) return ContactKind::kObstacle;
  if (closer(clearance.person_m, next.person_m)) return ContactKind::kPerson;
  return std::nullopt;
}

bool RobotBody::Impl::Released(const Clearance& now) const {
  const Vector3d way = T_world_base.translation() - touching->T_world_base.translation();
  return way.norm() > kReleased_m ||
         RotationDistance(T_world_base, touching->T_world_base) > kReleased_rad ||
         (touching->kind == ContactKind::kPerson && now.person_m >= kReleased_m);
}

void RobotBody::Impl::Move() {
  const double time_s = static_cast<double>(track.newest() + 1) * BodyTrack::kStep_s;
  const DriveState before = drive.state();
  drive.Step(BodyTrack::kStep_s);
  const DriveState& after = drive.state();
  Pose T_world_wanted = T_world_base;
  T_world_wanted.translation().head<2>() = after.position;
  T_world_wanted.linear() =
      RotationFromRpy(0.0, 0.0, after.yaw - before.yaw) * T_world_base.linear();
  const std::optional<Pose> T_world_next =
      Stands(before, after) ? T_world_base : OnGround(*scene, wheels(), T_world_wanted);
  const Clearance next = checker.At(T_world_next.value_or(T_world_base), time_s, kReleased_m);
  if (touching && Released(next)) touching.reset();
  if (const auto kind = Blocked(T_world_next, next); kind && !Stands(before, after)) {
    if (!touching) {
      touching = Contact{time_s, *kind, after.velocity, T_world_base};
      contacts.push_back(*touching);
    }
    drive.HaltAt(before);
  } else {
    if (kind == ContactKind::kPerson && !touching) {
      touching = Contact{time_s, *kind, {}, T_world_base};
      contacts.push_back(*touching);
    }
    T_world_base = *T_world_next;
    clearance = next;
  }
  Push(time_s);
}

void RobotBody::Impl::Push(double time_s) {
  BodyControl control = ControlAt(T_world_base, drive.state().yaw);
  const double liveliness = Liveliness(drive.state().velocity);
  for (const Wave& wave : waves) {
    control[wave.axis] += liveliness * wave.amplitude * std::sin(wave.rate * time_s + wave.phase);
  }
  track.Push(control);
}

RobotBody::RobotBody(const RobotBodyConfig& config, std::shared_ptr<const RayCaster> scene,
                     std::vector<PersonPath> people, std::uint32_t seed)
    : impl_(std::make_unique<Impl>(config, std::move(scene), std::move(people), seed)) {}

RobotBody::~RobotBody() = default;

void RobotBody::SetScene(std::shared_ptr<const RayCaster> scene) {
  impl_->scene = scene;
  impl_->checker.SetScene(std::move(scene));
}

void RobotBody::Place(const Pose& T_world_base) { impl_->Place(T_world_base); }

bool RobotBody::Command(const DriveCommand& command) { return impl_->drive.Command(command); }

std::vector<Contact> RobotBody::AdvanceTo(double time_s) {
  constexpr double kRounding = 1e-6;
  const auto now = static_cast<std::int64_t>(std::floor(time_s / BodyTrack::kStep_s + kRounding));
  while (impl_->track.newest() < now + BodyTrack::kLead) impl_->Move();
  std::vector<Contact> begun;
  std::deque<Contact>& contacts = impl_->contacts;
  for (; !contacts.empty() && contacts.front().time_s <= time_s; contacts.pop_front()) {
    begun.push_back(contacts.front());
  }
  return begun;
}

MotionState RobotBody::At(double time_s) const { return impl_->track.At(time_s); }

}  // namespace hv::sim
