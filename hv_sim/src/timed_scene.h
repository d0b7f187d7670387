#pragma once

#include <memory>
#include <vector>

#include "hv_sim/live_config.h"
#include "hv_sim/ray_caster.h"

namespace hv::sim {

/// The triangles of a world with the boxes that are there at the moment. Not thread-safe.
class TimedScene {
 public:
  explicit TimedScene(Mesh mesh);

  void Add(const TimedBox& box);

  /// Whether the scene has changed since the last call.
  bool Update(double time_s);

  const std::shared_ptr<const RayCaster>& scene() const { return scene_; }

 private:
  std::vector<bool> PresentAt(double time_s) const;

  Mesh mesh_;
  std::vector<TimedBox> boxes_;
  std::vector<bool> present_;
  std::shared_ptr<const RayCaster> scene_;
};

}  // namespace hv::sim
