#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hv_core/se3.h"
#include "hv_core/time.h"

namespace hv {

struct StampedPose {
  Time stamp;
  Pose pose = Pose::Identity();
};

/// Poses of one frame over time, strictly increasing in stamp. Not synchronised.
class Trajectory {
 public:
  Trajectory() = default;
  /// Sorts by stamp; of equal stamps the last one given stays.
  explicit Trajectory(std::vector<StampedPose> poses);

  /// Appends; returns false and leaves the trajectory as it was when `stamp` is not later than the
  /// last one.
  bool Append(Time stamp, const Pose& pose);

  const std::vector<StampedPose>& poses() const { return poses_; }
  std::size_t size() const { return poses_.size(); }
  bool empty() const { return poses_.empty(); }

  /// Pose at `stamp`: linear in translation, shortest arc in rotation. Nullopt outside the covered
  /// time, or where the two enclosing poses are more than `max_gap` seconds apart.
  std::optional<Pose> Interpolate(Time stamp, double max_gap = 1e9) const;

  /// Length of the polyline through the positions [m].
  double PathLength() const;

 private:
  std::vector<StampedPose> poses_;
};

/// Reads a TUM file: `stamp x y z qx qy qz qw` a line, `#` comments, blanks or commas between.
/// Unsorted stamps are sorted. Throws InputError naming file and line.
Trajectory ReadTum(const std::string& path);

/// The same from text in memory; `source` names it in messages.
Trajectory ParseTum(const std::string& text, const std::string& source);

/// Writes a TUM file with nine-digit stamps through a temporary file and a rename. Throws
/// InputError when the file cannot be written.
void WriteTum(const std::string& path, const Trajectory& trajectory);

}  // namespace hv
