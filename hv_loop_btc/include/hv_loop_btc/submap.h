#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "hv_core/config.h"
#include "hv_core/keyframe.h"

namespace hv::loop {

struct SubmapConfig {
  int keyframes = 10;
  int stride = 5;
  double leaf_m = 0.15;
  double max_range_m = 60.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// A keyframe of a submap.
struct SubmapMember {
  std::uint32_t keyframe = 0;
  Pose T_submap_keyframe = Pose::Identity();
};

/// What several consecutive keyframes see, as one cloud (methods section 2): a single sparse scan
/// is not enough for descriptors. Its frame is that of its middle keyframe.
struct Submap {
  std::uint32_t keyframe = 0;                     ///< id of the middle keyframe, names the submap
  Time stamp;                                     ///< of that keyframe
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< against gravity, submap frame, unit
  std::vector<SubmapMember> members;              ///< in order of time
  std::vector<Eigen::Vector3f> points;            ///< thinned, submap frame [m]
};

/// Points thinned to one (the mean) a cube of `leaf` metres, in order of first appearance.
std::vector<Eigen::Vector3f> Thinned(const std::vector<Eigen::Vector3f>& points, double leaf);

/// The cloud of a submap from stored keyframes (`load`: points of a keyframe in its frame),
/// thinned, submap frame.
std::vector<Eigen::Vector3f> SubmapCloud(
    const std::vector<SubmapMember>& members,
    const std::function<std::vector<Point>(std::uint32_t)>& load, double leaf_m);

/// Collects keyframes into overlapping submaps. Not thread-safe.
class SubmapBuilder {
 public:
  explicit SubmapBuilder(const SubmapConfig& config) : config_(config) {}

  /// Takes the next keyframe; every `stride` keyframes, and when a segment of the odometry ends
  /// with keyframes not yet in a submap, a submap is returned.
  std::optional<Submap> Add(Keyframe keyframe);

  /// The submap of what is left at the end of the data.
  std::optional<Submap> Finish();

 private:
  std::optional<Submap> Close();
  Submap Build() const;

  SubmapConfig config_;
  std::deque<Keyframe> window_;
  int fresh_ = 0;  ///< keyframes of the window that are in no submap yet
};

}  // namespace hv::loop
