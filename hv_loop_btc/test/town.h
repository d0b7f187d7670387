#pragma once

#include <random>
#include <vector>

#include <Eigen/Core>

#include "hv_core/keyframe.h"
#include "hv_loop_btc/submap.h"

namespace hv::loop {

/// A square of upright blocks on a floor at z = 0, the same for the same seed.
class Town {
 public:
  explicit Town(unsigned seed, int blocks = 18) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-kHalf, kHalf);
    std::uniform_real_distribution<double> width(0.3, 1.6);
    std::uniform_real_distribution<double> height(0.8, 3.5);
    for (int i = 0; i < blocks; ++i) {
      const double x = place(random);
      const double y = place(random);
      const double wx = width(random);
      const double wy = width(random);
      blocks_.push_back({{x, y, 0.0}, {wx, wy, height(random)}});
    }
  }

  /// Points on all surfaces within `reach` of `position`, in the frame `T_town_sensor`, with noise.
  std::vector<Eigen::Vector3f> Seen(const Pose& T_town_sensor, double reach, double per_m2,
                                    std::mt19937& random) const {
    std::vector<Eigen::Vector3f> points;
    std::normal_distribution<double> noise(0.0, 0.01);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const Pose T_sensor_town = T_town_sensor.inverse();
    const Eigen::Vector3d here = T_town_sensor.translation();
    const auto add = [&](const Eigen::Vector3d& p) {
      if ((p - here).head<2>().norm() > reach) return;
      const Eigen::Vector3d noisy =
          p + Eigen::Vector3d(noise(random), noise(random), noise(random));
      points.push_back((T_sensor_town * noisy).cast<float>());
    };
    for (const Block& block : blocks_) {
      const double area = 2.0 * block.size.z() * (block.size.x() + block.size.y());
      for (int i = 0; i < static_cast<int>(area * per_m2); ++i) {
        const double along = unit(random) * (block.size.x() + block.size.y());
        const bool front = along < block.size.x();
        const double far = unit(random) < 0.5 ? 0.0 : 1.0;
        const double dx = front ? along : far * block.size.x();
        const double dy = front ? far * block.size.y() : along - block.size.x();
        add(block.corner + Eigen::Vector3d(dx, dy, unit(random) * block.size.z()));
      }
    }
    for (int i = 0; i < static_cast<int>(4.0 * reach * reach * per_m2); ++i) {
      add({here.x() + (2.0 * unit(random) - 1.0) * reach,
           here.y() + (2.0 * unit(random) - 1.0) * reach, 0.0});
    }
    return points;
  }

  /// What is seen from a pose, as a submap.
  Submap SubmapAt(std::uint32_t keyframe, const Pose& T_town_sensor, std::mt19937& random) const {
    Submap submap;
    submap.keyframe = keyframe;
    submap.stamp = Time::FromSeconds(keyframe);
    submap.up = T_town_sensor.linear().transpose() * Eigen::Vector3d::UnitZ();
    submap.members.push_back({keyframe, Pose::Identity()});
    submap.points = Thinned(Seen(T_town_sensor, 15.0, 120.0, random), 0.15);
    return submap;
  }

  static constexpr double kHalf = 14.0;

 private:
  struct Block {
    Eigen::Vector3d corner;
    Eigen::Vector3d size;
  };
  std::vector<Block> blocks_;
};

inline Pose SensorPose(double x, double y, double yaw, double roll = 0.0, double pitch = 0.0) {
  return MakePose(RotationFromRpy(roll, pitch, yaw), {x, y, 1.2});
}

}  // namespace hv::loop
