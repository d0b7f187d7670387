#include "hv_lio/voxel_map.h"

#include <algorithm>
#include <cmath>

namespace hv::lio {
namespace {

constexpr std::uint8_t kSplitAfterDisagreements = 20;
constexpr double kDisagreementSigmas = 5.0;
constexpr double kKeptAfterSplit = 0.1;

/// Octant of `point` about `center`: bit 0 for x, 1 for y, 2 for z.
int OctantOf(const Eigen::Vector3d& point, const Eigen::Vector3d& center) {
  return (point.x() >= center.x() ? 1 : 0) | (point.y() >= center.y() ? 2 : 0) |
         (point.z() >= center.z() ? 4 : 0);
}

/// Centre of an octant of a cube with the given centre and edge.
Eigen::Vector3d OctantCenter(const Eigen::Vector3d& center, double edge, int octant) {
  const double step = 0.25 * edge;
  return center + Eigen::Vector3d((octant & 1) != 0 ? step : -step, (octant & 2) != 0 ? step : -step,
                                  (octant & 4) != 0 ? step : -step);
}

}  // namespace

void VoxelMapConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("voxel_size_m", voxel_size_m, "edge of a root voxel [m]");
  visitor.Field("layers", layers, "layers of voxels: 1 = never subdivided, 3 = down to a quarter");
  visitor.Field("capacity", capacity, "root voxels kept; the least recently used are evicted");
  visitor.Field("max_subdivisions", max_subdivisions, "subdivided voxels kept in all");
  visitor.Section("fit", fit, "fitting of planes and Gaussians");
  visitor.Section("merge", merge, "merging of coplanar neighbours");
}

void VoxelMapConfig::Validate(ConfigProblems& problems) const {
  problems.Require(voxel_size_m >= 0.05, "map.voxel_size_m", "must be at least 0.05");
  problems.Require(layers >= 1 && layers <= 5, "map.layers", "must lie between 1 and 5");
  problems.Require(capacity >= 100 && capacity <= 100000000, "map.capacity",
                   "must lie between 100 and 1e8");
  problems.Require(max_subdivisions >= 0, "map.max_subdivisions", "must not be negative");
  fit.Validate(problems);
  merge.Validate(problems);
}

VoxelMap::VoxelMap(const VoxelMapConfig& config)
    : config_(config),
      table_(static_cast<std::size_t>(config.capacity)),
      roots_(static_cast<std::size_t>(config.capacity)),
      merger_(config.merge, config.fit, static_cast<std::size_t>(config.capacity)) {
  blocks_.reserve(static_cast<std::size_t>(config.max_subdivisions));
}

void VoxelMap::Clear() {
  table_.Clear();
  roots_.assign(roots_.size(), Voxel());
  blocks_.clear();
  free_blocks_.clear();
  merger_.Clear();
  blocks_in_use_ = 0;
}

VoxelKey VoxelMap::KeyOf(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d scaled = point / config_.voxel_size_m;
  return {static_cast<std::int32_t>(std::floor(scaled.x())),
          static_cast<std::int32_t>(std::floor(scaled.y())),
          static_cast<std::int32_t>(std::floor(scaled.z()))};
}

Eigen::Vector3d VoxelMap::RootCenter(std::uint32_t root) const {
  const VoxelKey& key = table_.key(root);
  return config_.voxel_size_m * Eigen::Vector3d(key.x + 0.5, key.y + 0.5, key.z + 0.5);
}

void VoxelMap::Insert(const std::vector<SurfaceCell>& cells, const Pose& T_odom_imu) {
  ++scan_number_;
  sensor_position_ = T_odom_imu.translation().cast<float>();
  const std::vector<Entry> entries = MakeEntries(cells, T_odom_imu);
  std::vector<Target> targets;
  targets.reserve(entries.size());
  for (const Entry& entry : entries) {
    const bool evicted_by_this_scan = !(table_.key(entry.root) == entry.key);
    if (evicted_by_this_scan) continue;
    targets.push_back({&roots_[entry.root], &entry, Eigen::Vector3d::Zero()});
  }
  for (int layer = 0; layer < config_.layers && !targets.empty(); ++layer) {
    FillLayer(targets, layer);
    targets = ChildrenOf(targets, layer);
  }
}

std::vector<VoxelMap::Entry> VoxelMap::MakeEntries(const std::vector<SurfaceCell>& cells,
                                                   const Pose& T_odom_imu) {
  const Eigen::Matrix3d rotation = T_odom_imu.linear();
  std::vector<Entry> entries(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const SurfaceCell& cell = cells[i];
    const Eigen::Vector3d mean = T_odom_imu * cell.mean;
    Entry& entry = entries[i];
    entry.key = KeyOf(mean);
    entry.root = TouchRoot(entry.key);
    entry.count = cell.count;
    entry.mean = mean - RootCenter(entry.root);
    entry.scatter = rotation * cell.scatter * rotation.transpose();
    entry.noise = cell.noise.trace() / (3.0 * cell.count);
  }
  return entries;
}

void VoxelMap::FillLayer(const std::vector<Target>& targets, int layer) {
  for (const Target& target : targets) Accumulate(*target.entry, *target.voxel);
  for (const Target& target : targets) Refit(target, layer);
}

std::vector<VoxelMap::Target> VoxelMap::ChildrenOf(const std::vector<Target>& targets, int layer) {
  const double edge = config_.voxel_size_m / static_cast<double>(1 << layer);
  std::vector<Target> children;
  for (const Target& target : targets) {
    if (target.voxel->children == kNoIndex) continue;
    const int octant = OctantOf(target.entry->mean, target.center);
    children.push_back({&blocks_[target.voxel->children][static_cast<std::size_t>(octant)],
                        target.entry, OctantCenter(target.center, edge, octant)});
  }
  return children;
}

void VoxelMap::Accumulate(const Entry& entry, Voxel& voxel) {
  if (voxel.settled) {
    Contradict(entry, voxel);
    if (voxel.settled) return;
  }
  voxel.sums.Add(entry.count, entry.mean, entry.scatter);
  if (voxel.last_scan == scan_number_) return;
  voxel.last_scan = scan_number_;
  if (voxel.scans == 0) voxel.first_seen_from = sensor_position_;
  ++voxel.scans;
  const double baseline =
      static_cast<double>((sensor_position_ - voxel.first_seen_from).norm());
  voxel.seen_from_afar = voxel.seen_from_afar || baseline >= config_.fit.gaussian_baseline_m;
  const double shared = config_.fit.scan_sigma_m * config_.fit.scan_sigma_m;
  voxel.information += 1.0 / (shared + entry.noise);
}

void VoxelMap::Contradict(const Entry& entry, Voxel& voxel) {
  const SurfaceFeature& plane = voxel.feature;
  const Eigen::Vector3d center = plane.center - RootCenter(entry.root);
  const double distance = plane.normal().dot(entry.mean - center);
  const double spread = plane.normal().dot(entry.scatter * plane.normal());
  const double variance = plane.variance[2] + std::max(0.0, spread) + entry.noise;
  const bool agrees = distance * distance < kDisagreementSigmas * kDisagreementSigmas * variance;
  if (agrees) {
    voxel.disagreements = static_cast<std::uint8_t>(std::max(0, voxel.disagreements - 1));
    return;
  }
  if (++voxel.disagreements < kSplitAfterDisagreements) return;
  if (&voxel == &roots_[entry.root]) merger_.Leave(CandidateOf(entry.root));
  voxel.settled = false;
  voxel.scans = 0;
  voxel.disagreements = 0;
  voxel.information *= kKeptAfterSplit;
  voxel.sums.Fade(kKeptAfterSplit);
}

void VoxelMap::Refit(const Target& target, int layer) {
  Voxel& voxel = *target.voxel;
  if (voxel.settled) return;
  const double grown = voxel.fitted_count * (1.0 + 0.01 * config_.fit.refit_percent);
  const bool due = voxel.scans >= config_.fit.settle_scans;
  if (voxel.sums.count <= grown && !due) return;
  voxel.fitted_count = voxel.sums.count;
  FitFeature(voxel.sums, RootCenter(target.entry->root), voxel.information, config_.fit,
             voxel.feature);
  if (voxel.planar() && due) {
    voxel.settled = true;
    ReleaseChildren(voxel);
    if (layer == 0) MergeWithNeighbors(target.entry->root);
  }
  const bool divisible = voxel.feature.kind == SurfaceFeature::Kind::kGaussian &&
                         voxel.children == kNoIndex && layer + 1 < config_.layers;
  if (divisible) Subdivide(voxel);
}

void VoxelMap::Subdivide(Voxel& voxel) {
  if (!free_blocks_.empty()) {
    voxel.children = free_blocks_.back();
    free_blocks_.pop_back();
    blocks_[voxel.children] = Block();
  } else if (blocks_.size() < blocks_.capacity()) {
    voxel.children = static_cast<std::uint32_t>(blocks_.size());
    blocks_.emplace_back();
  } else {
    return;
  }
  ++blocks_in_use_;
}

void VoxelMap::ReleaseChildren(Voxel& voxel) {
  if (voxel.children == kNoIndex) return;
  const std::uint32_t block = voxel.children;
  voxel.children = kNoIndex;
  for (Voxel& child : blocks_[block]) ReleaseChildren(child);
  free_blocks_.push_back(block);
  --blocks_in_use_;
}

PlaneMerger::Candidate VoxelMap::CandidateOf(std::uint32_t root) const {
  return {root, &roots_[root], RootCenter(root)};
}

void VoxelMap::MergeWithNeighbors(std::uint32_t root) {
  const VoxelKey key = table_.key(root);
  for (int axis = 0; axis < 3; ++axis) {
    for (const int step : {-1, 1}) {
      const VoxelKey neighbor{key.x + (axis == 0 ? step : 0), key.y + (axis == 1 ? step : 0),
                              key.z + (axis == 2 ? step : 0)};
      const std::uint32_t slot = table_.Find(neighbor);
      if (slot == kNoIndex || !roots_[slot].settled) continue;
      merger_.TryMerge(CandidateOf(root), CandidateOf(slot));
    }
  }
}

std::uint32_t VoxelMap::TouchRoot(const VoxelKey& key) {
  const std::uint32_t known = table_.Find(key);
  if (known != kNoIndex) {
    table_.Touch(known);
    return known;
  }
  if (table_.full()) Evict(table_.oldest());
  const std::uint32_t root = table_.Insert(key);
  roots_[root] = Voxel();
  return root;
}

void VoxelMap::Evict(std::uint32_t root) {
  merger_.Leave(CandidateOf(root));
  ReleaseChildren(roots_[root]);
  table_.Erase(root);
  ++evictions_;
}

const SurfaceFeature* VoxelMap::Find(const Eigen::Vector3d& point) const {
  const std::uint32_t root = table_.Find(KeyOf(point));
  if (root == kNoIndex) return nullptr;
  const Voxel* voxel = &roots_[root];
  const std::uint32_t plane = merger_.PlaneOf(root);
  if (plane != 0) return &merger_.feature(plane);
  const Eigen::Vector3d local = point - RootCenter(root);
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  const SurfaceFeature* gaussian = nullptr;
  for (double edge = config_.voxel_size_m;; edge *= 0.5) {
    if (voxel->planar()) return &voxel->feature;
    const bool fitted = voxel->feature.kind == SurfaceFeature::Kind::kGaussian;
    if (fitted && voxel->seen_from_afar) gaussian = &voxel->feature;
    if (voxel->children == kNoIndex) return gaussian;
    const int octant = OctantOf(local, center);
    voxel = &blocks_[voxel->children][static_cast<std::size_t>(octant)];
    center = OctantCenter(center, edge, octant);
  }
}

std::vector<VoxelView> VoxelMap::View(std::size_t limit) const {
  std::vector<VoxelView> views;
  for (std::uint32_t root = table_.newest(); root != kNoIndex && views.size() < limit;
       root = table_.older(root)) {
    AppendView(root, views);
  }
  if (views.size() > limit) views.resize(limit);
  return views;
}

void VoxelMap::AppendView(std::uint32_t root, std::vector<VoxelView>& views) const {
  struct Item {
    const Voxel* voxel;
    double edge;
  };
  std::vector<Item> open{{&roots_[root], config_.voxel_size_m}};
  while (!open.empty()) {
    const Item item = open.back();
    open.pop_back();
    const Voxel& voxel = *item.voxel;
    if (!voxel.planar() && voxel.children != kNoIndex) {
      for (const Voxel& child : blocks_[voxel.children]) open.push_back({&child, 0.5 * item.edge});
      continue;
    }
    if (voxel.feature.kind == SurfaceFeature::Kind::kNone) continue;
    VoxelView view;
    view.plane_id = &voxel == &roots_[root] ? merger_.PlaneOf(root) : 0;
    view.kind = !voxel.planar()        ? VoxelView::Kind::kGaussian
                : view.plane_id != 0 ? VoxelView::Kind::kMergedPlane
                                     : VoxelView::Kind::kPlane;
    view.center = voxel.feature.center;
    view.axes = voxel.feature.axes;
    view.sigma = voxel.feature.variance.cwiseSqrt();
    view.size = item.edge;
    views.push_back(view);
  }
}

}  // namespace hv::lio
