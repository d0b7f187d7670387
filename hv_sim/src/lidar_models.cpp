#include <array>
#include <cmath>

#include "hv_core/angles.h"
#include "hv_sim/lidar.h"

namespace hv::sim {
namespace {

constexpr int kChannels = 32;

}  // namespace

Eigen::Vector3d LidarModel::Direction(int column, std::size_t channel) const {
  const double turn = 2.0 * M_PI * column / columns + azimuth_offset[channel];
  const double azimuth = start_azimuth + (clockwise ? -turn : turn);
  const double flat = std::cos(elevation[channel]);
  return {flat * std::cos(azimuth), flat * std::sin(azimuth), std::sin(elevation[channel])};
}

LidarModel PandarXt32() {
  LidarModel model;
  model.name = "pandar_xt32";
  model.start_azimuth = 90.0 * kRadiansPerDegree;
  for (int channel = 0; channel < kChannels; ++channel) {
    model.elevation.push_back((15.0 - channel) * kRadiansPerDegree);
    // Straight line through the calibration of a real unit: 0.09 to -0.13 degrees, and within
    // 0.011 degrees of each channel. It holds the turn during the column already.
    model.azimuth_offset.push_back((0.0905 - 0.0071 * channel) * kRadiansPerDegree);
    model.firing_delay.push_back((0.368 + 1.512 * channel) * 1e-6);
  }
  return model;
}

LidarModel Hdl32e() {
  constexpr double kLaserPeriod = 1.152e-6;  // user's manual, appendix E
  LidarModel model;
  model.name = "hdl_32e";
  model.columns = 2170;
  model.column_period = 40 * kLaserPeriod;
  model.range_sigma = 0.015;
  model.max_range = 100.0;
  model.range_at_10_percent = 50.0;
  for (int laser = 0; laser < kChannels; ++laser) {
    // The lower and the upper bank of 16 lasers, 4/3 degrees apart, take turns.
    const double lowest = laser % 2 == 0 ? -92.0 / 3.0 : -28.0 / 3.0;
    model.elevation.push_back((lowest + 4.0 / 3.0 * (laser / 2)) * kRadiansPerDegree);
    model.firing_delay.push_back(laser * kLaserPeriod);
    model.azimuth_offset.push_back(2.0 * M_PI * laser * kLaserPeriod / model.period());
  }
  return model;
}

}  // namespace hv::sim
