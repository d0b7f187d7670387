#include "hv_loop_btc/submap.h"

#include <unordered_map>
#include <utility>

#include "hv_core/cube_key.h"

namespace hv::loop {
void SubmapConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("keyframes", keyframes, "keyframes a submap is made of");
  visitor.Field("stride", stride, "keyframes from one submap to the next");
  visitor.Field("leaf_m", leaf_m, "edge of the cubes a submap is thinned with [m]");
  visitor.Field("max_range_m", max_range_m, "points farther from their sensor are left out [m]");
}

void SubmapConfig::Validate(ConfigProblems& problems) const {
  problems.Require(keyframes >= 1, "submap.keyframes", "must be at least 1");
  problems.Require(stride >= 1 && stride <= keyframes, "submap.stride",
                   "must be at least 1 and at most submap.keyframes");
  problems.Require(leaf_m >= 0.01, "submap.leaf_m", "must be at least 0.01");
  problems.Require(max_range_m > 0.0, "submap.max_range_m", "must be positive");
}

std::vector<Eigen::Vector3f> Thinned(const std::vector<Eigen::Vector3f>& points, double leaf) {
  struct Mean {
    Eigen::Vector3f sum;
    float count;
  };
  const float inverse_size = static_cast<float>(1.0 / leaf);
  std::unordered_map<std::uint64_t, std::uint32_t> index;
  index.reserve(points.size());
  std::vector<Mean> means;
  for (const Eigen::Vector3f& point : points) {
    const auto [place, added] =
        index.try_emplace(CubeKey(point, inverse_size), static_cast<std::uint32_t>(means.size()));
    if (added) means.push_back({Eigen::Vector3f::Zero(), 0.0F});
    Mean& mean = means[place->second];
    mean.sum += point;
    mean.count += 1.0F;
  }
  std::vector<Eigen::Vector3f> thinned;
  thinned.reserve(means.size());
  for (const Mean& mean : means) thinned.push_back(mean.sum / mean.count);
  return thinned;
}

std::vector<Eigen::Vector3f> SubmapCloud(
    const std::vector<SubmapMember>& members,
    const std::function<std::vector<Point>(std::uint32_t)>& load, double leaf_m) {
  std::vector<Eigen::Vector3f> all;
  for (const SubmapMember& member : members) {
    const Eigen::Isometry3f transform = member.T_submap_keyframe.cast<float>();
    for (const Point& point : load(member.keyframe)) {
      all.push_back(transform * Eigen::Vector3f(point.x, point.y, point.z));
    }
  }
  return Thinned(all, leaf_m);
}

std::optional<Submap> SubmapBuilder::Add(Keyframe keyframe) {
  std::optional<Submap> finished;
  if (!window_.empty() && window_.back().segment != keyframe.segment) finished = Finish();
  window_.push_back(std::move(keyframe));
  ++fresh_;
  while (window_.size() > static_cast<std::size_t>(config_.keyframes)) window_.pop_front();
  const bool full = window_.size() == static_cast<std::size_t>(config_.keyframes);
  if (!finished && full && fresh_ >= config_.stride) return Close();
  return finished;
}

std::optional<Submap> SubmapBuilder::Finish() {
  std::optional<Submap> submap;
  if (fresh_ > 0) submap = Close();
  window_.clear();
  fresh_ = 0;
  return submap;
}

std::optional<Submap> SubmapBuilder::Close() {
  fresh_ = 0;
  return Build();
}

Submap SubmapBuilder::Build() const {
  const Keyframe& middle = window_[window_.size() / 2];
  const Pose T_submap_odom = middle.T_odom_imu.inverse();
  Submap submap;
  submap.keyframe = middle.id;
  submap.stamp = middle.stamp;
  submap.up = -(T_submap_odom.linear() * middle.gravity_odom).normalized();
  const float reach = static_cast<float>(config_.max_range_m);
  std::vector<Eigen::Vector3f> all;
  for (const Keyframe& keyframe : window_) {
    const Pose T_submap_keyframe = T_submap_odom * keyframe.T_odom_imu;
    submap.members.push_back({keyframe.id, T_submap_keyframe});
    const Eigen::Isometry3f transform = T_submap_keyframe.cast<float>();
    for (const Point& point : keyframe.points) {
      const Eigen::Vector3f p(point.x, point.y, point.z);
      if (p.squaredNorm() < reach * reach) all.push_back(transform * p);
    }
  }
  submap.points = Thinned(all, config_.leaf_m);
  return submap;
}

}  // namespace hv::loop
