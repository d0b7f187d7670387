#include "hv_sim/motion.h"

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "hv_core/angles.h"
#include "hv_core/error.h"
#include "motion_jet.h"
#include "motion_plan.h"
#include "motion_spline.h"

namespace hv::sim {
namespace {

/// Sway relative to the planned path: offsets along the path's heading [m] and angles [rad].
enum Sway { kForward, kLeft, kUp, kRoll, kPitchUp, kTurn, kSways };

struct Harmonic {
  Sway sway;
  double amplitude;  ///< [m] or [deg]
  double frequency;  ///< [Hz]
};

struct Style {
  PlanProfile plan;
  double roll_deg = 0.0;   ///< constant tilt of the grip
  double pitch_deg = 0.0;  ///< constant tilt of the grip
  std::vector<Harmonic> harmonics;
};

Style WalkStyle() {
  Style style;
  style.plan.idle_activity = 0.25;
  style.roll_deg = 1.5;
  style.pitch_deg = 3.0;
  style.harmonics = {{kUp, 0.030, 1.8},     {kForward, 0.012, 1.8}, {kLeft, 0.025, 0.9},
                     {kRoll, 2.5, 0.9},     {kRoll, 1.5, 0.23},     {kPitchUp, 1.5, 1.8},
                     {kPitchUp, 3.0, 0.31}, {kTurn, 3.0, 0.9},      {kTurn, 7.0, 0.17}};
  return style;
}

Style RobotStyle() {
  Style style;
  style.plan.speed = 0.8;
  style.plan.acceleration = 0.4;
  style.plan.yaw_rate = 0.7;
  style.plan.height = 0.6;
  style.plan.step_s = 0.3;
  style.plan.stop_every = 35.0;
  style.plan.follows_slope = true;
  style.harmonics = {{kUp, 0.0002, 11.0},
                     {kUp, 0.001, 2.6},
                     {kRoll, 0.15, 2.1},
                     {kPitchUp, 0.2, 2.9},
                     {kPitchUp, 0.03, 13.0}};
  return style;
}

Style Segway() {
  Style style;
  style.plan.speed = 1.3;
  style.plan.acceleration = 0.6;
  style.plan.yaw_rate = 0.8;
  style.plan.height = 1.2;
  style.plan.idle_activity = 0.3;
  style.plan.follows_slope = true;
  style.harmonics = {{kPitchUp, 4.0, 0.55}, {kPitchUp, 1.2, 1.2}, {kForward, 0.05, 0.55},
                     {kUp, 0.003, 2.7},     {kRoll, 0.6, 1.1},    {kTurn, 1.0, 0.4}};
  return style;
}

Style Aggressive() {
  Style style;
  style.plan.speed = 1.8;
  style.plan.acceleration = 1.5;
  style.plan.yaw_rate = 1.6;
  style.plan.step_s = 0.2;
  style.plan.idle_activity = 0.6;
  style.roll_deg = -2.0;
  style.pitch_deg = 4.0;
  style.harmonics = {{kUp, 0.045, 2.1},    {kUp, 0.004, 5.7},     {kForward, 0.02, 2.1},
                     {kLeft, 0.035, 1.05}, {kLeft, 0.003, 6.3},   {kRoll, 11.0, 0.72},
                     {kRoll, 2.0, 4.1},    {kPitchUp, 10.0, 0.6}, {kPitchUp, 1.5, 4.9},
                     {kTurn, 21.0, 0.43},  {kTurn, 5.0, 1.4}};
  return style;
}

const std::map<std::string, Style (*)()>& Styles() {
  static const std::map<std::string, Style (*)()> kStyles = {
      {"walk", WalkStyle}, {"robot", RobotStyle}, {"segway", Segway}, {"aggressive", Aggressive}};
  return kStyles;
}

class StyledMotion : public Motion {
 public:
  StyledMotion(const World& world, const MotionConfig& config, const Style& style)
      : style_(style),
        skip_s_(config.skip_s),
        spline_(style.plan.step_s, PlanControls(world, config, style.plan)) {
    std::mt19937 random(static_cast<std::uint32_t>(config.seed) + 0x5EEDU);
    std::uniform_real_distribution<double> phase(0.0, 2.0 * M_PI);
    std::uniform_real_distribution<double> detune(0.95, 1.05);
    for (const Harmonic& harmonic : style.harmonics) {
      const double unit = harmonic.sway >= kRoll ? kRadiansPerDegree : 1.0;
      const double rate = 2.0 * M_PI * harmonic.frequency * detune(random);
      waves_.push_back({harmonic.sway, harmonic.amplitude * unit, rate, phase(random)});
    }
  }

  MotionState At(double seconds) const override {
    const double time_s = seconds + skip_s_;
    const MotionSpline::Sample plan = spline_.At(time_s);
    const auto channel = [&plan](Channel index) {
      return Jet{plan.value[index], plan.first[index], plan.second[index]};
    };
    std::array<Jet, kSways> sway = SwayAt(time_s);
    const Jet activity = channel(kActivity);
    for (Jet& jet : sway) jet = activity * jet;

    const Jet heading = channel(kYaw);
    const Jet sine = Sin(heading);
    const Jet cosine = Cos(heading);
    MotionState state;
    SetTranslation(channel(kX) + cosine * sway[kForward] - sine * sway[kLeft],
                   channel(kY) + sine * sway[kForward] + cosine * sway[kLeft],
                   channel(kZ) + sway[kUp], state);
    SetRotation(
        Jet{style_.roll_deg * kRadiansPerDegree, 0.0, 0.0} + sway[kRoll],
        Jet{style_.pitch_deg * kRadiansPerDegree, 0.0, 0.0} + channel(kPitch) + sway[kPitchUp],
        heading + sway[kTurn], state);
    return state;
  }

 private:
  struct Wave {
    Sway sway;
    double amplitude;
    double rate;  ///< [rad/s]
    double phase;
  };

  std::array<Jet, kSways> SwayAt(double time_s) const {
    std::array<Jet, kSways> sway;
    for (const Wave& wave : waves_) {
      const double angle = wave.rate * time_s + wave.phase;
      const double sine = wave.amplitude * std::sin(angle);
      const double cosine = wave.amplitude * std::cos(angle);
      sway[wave.sway] =
          sway[wave.sway] + Jet{sine, wave.rate * cosine, -wave.rate * wave.rate * sine};
    }
    return sway;
  }

  Style style_;
  double skip_s_;
  MotionSpline spline_;
  std::vector<Wave> waves_;
};

}  // namespace

MotionState Attached(const MotionState& body, const Pose& T_body_frame) {
  const Eigen::Matrix3d R_world_body = body.T_world_body.linear();
  const Eigen::Matrix3d R_frame_body = T_body_frame.linear().transpose();
  const Eigen::Vector3d arm = T_body_frame.translation();
  const Eigen::Vector3d arm_velocity = body.angular_velocity.cross(arm);
  const Eigen::Vector3d arm_acceleration =
      body.angular_acceleration.cross(arm) + body.angular_velocity.cross(arm_velocity);
  MotionState state;
  state.T_world_body = body.T_world_body * T_body_frame;
  state.velocity = body.velocity + R_world_body * arm_velocity;
  state.acceleration = body.acceleration + R_world_body * arm_acceleration;
  state.angular_velocity = R_frame_body * body.angular_velocity;
  state.angular_acceleration = R_frame_body * body.angular_acceleration;
  return state;
}

void MotionConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("style", style, "walk, robot, segway or aggressive");
  visitor.Field("duration_s", duration_s, "length of the recording [s]");
  visitor.Field("still_s", still_s, "standing still at the start [s]");
  visitor.Field("skip_s", skip_s, "left out before the recording; > still_s starts moving [s]");
}

void MotionConfig::Validate(ConfigProblems& problems) const {
  problems.Require(Styles().count(style) > 0, "style", "unknown style '" + style + "'");
  problems.Require(duration_s > 0.0 && duration_s <= 1e5, "duration_s", "must be in (0, 1e5]");
  problems.Require(still_s >= 0.0, "still_s", "must not be negative");
  problems.Require(skip_s >= 0.0, "skip_s", "must not be negative");
}

std::vector<std::string> MotionStyles() { return {"walk", "robot", "segway", "aggressive"}; }

std::unique_ptr<Motion> MakeMotion(const World& world, const MotionConfig& config) {
  const auto style = Styles().find(config.style);
  if (style == Styles().end()) {
    throw InputError("trajectory '" + config.style +
                     "' is unknown; known are walk, robot, segway, aggressive");
  }
  return std::make_unique<StyledMotion>(world, config, style->second());
}

}  // namespace hv::sim
