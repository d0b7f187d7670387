#include "hv_lio/moving_start.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "hv_core/so3.h"

namespace hv::lio {
namespace {

constexpr int kMostRuns = 6;
/// Runs end when they change velocity and attitude by less than this [m/s, rad].
constexpr double kConverged = 2e-3;

/// The same motion in an odom frame whose z axis is up.
NavState Levelled(NavState state) {
  const Eigen::Matrix3d level =
      Eigen::Quaterniond::FromTwoVectors(state.gravity, -Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  state.rotation = level * state.rotation;
  state.velocity = level * state.velocity;
  state.gravity = level * state.gravity;
  return state;
}

NavState CarryBack(NavState state, const std::vector<WindowScan>& window) {
  for (auto scan = window.rbegin(); scan != window.rend(); ++scan) {
    state = CarryBack(state, scan->steps);
  }
  return state;
}

double Change(const NavState& before, const NavState& after) {
  const ErrorVector difference = after.Minus(before);
  return std::max(difference.segment<3>(ErrorIndex::kVelocity).norm(),
                  difference.segment<3>(ErrorIndex::kRotation).norm());
}

std::vector<ScanResult> Run(const std::vector<WindowScan>& window, Odometry& odometry) {
  std::vector<ScanResult> results;
  for (const WindowScan& part : window) {
    results.push_back(odometry.Process(part.scan, part.steps));
  }
  return results;
}

}  // namespace

NavState CarryBack(NavState state, const std::vector<ImuStep>& steps) {
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    const Eigen::Vector3d turn = (step->angular_velocity - state.gyro_bias) * step->dt;
    state.rotation = so3::Normalize(state.rotation * so3::Exp(-turn));
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
    if (step->quality != ImuQuality::kMissing) {
      acceleration =
          state.rotation * so3::Exp(0.5 * turn) * (step->acceleration - state.accel_bias) +
          state.gravity;
    }
    state.velocity -= acceleration * step->dt;
    state.position -= state.velocity * step->dt + 0.5 * step->dt * step->dt * acceleration;
  }
  return state;
}

std::vector<ScanResult> StartInMotion(const std::vector<WindowScan>& window,
                                      const InitialState& initial, Odometry& odometry) {
  InitialState start = initial;
  start.state = CarryBack(initial.state, window);
  start.state.position.setZero();
  odometry.Start(window.front().scan.stamp, start);
  const Eigen::Vector3d origin = odometry.state().position;
  std::vector<ScanResult> results = Run(window, odometry);
  start.moving = false;
  for (int run = 1; run < kMostRuns; ++run) {
    const NavState before = start.state;
    start.state = Levelled(CarryBack(odometry.state(), window));
    start.state.position = origin;
    odometry.Start(window.front().scan.stamp, start);
    results = Run(window, odometry);
    if (Change(before, start.state) < kConverged) break;
  }
  return results;
}

}  // namespace hv::lio
