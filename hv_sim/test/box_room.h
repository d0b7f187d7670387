#pragma once

#include <cstdint>

#include "hv_sim/recording.h"
#include "hv_sim/world.h"

namespace hv::sim {

/// A closed hall of length x width x 8 m around a small square route.
inline World BoxRoom(float length, float width) {
  World world;
  world.name = "box";
  world.route = {{-3, -2, 0}, {3, -2, 0}, {3, 2, 0}, {-3, 2, 0}};
  for (int corner = 0; corner < 8; ++corner) {
    world.mesh.vertices.emplace_back((corner & 1) != 0 ? length / 2 : -length / 2,
                                     (corner & 2) != 0 ? width / 2 : -width / 2,
                                     (corner & 4) != 0 ? 8.0F : 0.0F);
  }
  world.mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 7, 5}, {4, 6, 7}, {0, 5, 1}, {0, 4, 5},
                          {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  world.mesh.reflectivity.assign(world.mesh.triangles.size(), 0.8F);
  return world;
}

/// A short recording with few points.
inline RecordingConfig SmallRecording(const std::string& format, double duration_s) {
  RecordingConfig config;
  config.format = format;
  config.suite = DefaultSuite(format);
  config.motion.style = "robot";
  config.motion.duration_s = duration_s;
  config.motion.still_s = 0.5;
  config.point_share = 0.05;
  return config;
}

}  // namespace hv::sim
