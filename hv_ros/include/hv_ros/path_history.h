#pragma once

#include <cstddef>

#include <nav_msgs/Path.h>

#include "hv_core/se3.h"
#include "hv_core/time.h"

namespace hv {

/// The driven path with bounded memory: a pose is kept when it is far enough from the last one
/// kept; when the path is full, every second pose goes and the distance doubles, so that the whole
/// way stays visible. Not thread-safe.
class PathHistory {
 public:
  /// `min_distance` in metres; `max_poses` at least 2.
  PathHistory(double min_distance, std::size_t max_poses);

  /// Returns whether the pose was kept. Starts over when `stamp` lies before the last one kept.
  bool Add(Time stamp, const Pose& pose);
  void Clear() { path_.poses.clear(); }

  /// The path in `frame`, stamped with its last pose.
  nav_msgs::Path ToMessage(const std::string& frame) const;
  std::size_t size() const { return path_.poses.size(); }

 private:
  void DropEverySecond();

  double min_distance_;
  const std::size_t max_poses_;
  nav_msgs::Path path_;
};

}  // namespace hv
