#include "height_octree.h"

#include <algorithm>
#include <cmath>

namespace hv::navigation {
namespace {

using Mark = ScanMarks::Mark;

constexpr Mark kSaysSomething = ScanMarks::kHit | ScanMarks::kPassed;

bool AnyOf(const Mark* marks, std::size_t count, Mark bits) {
  Mark any = 0;
  for (std::size_t i = 0; i < count; ++i) any = static_cast<Mark>(any | marks[i]);
  return (any & bits) != 0;
}

int SliceOf(float height) {
  const auto slice = static_cast<int>((height - std::floor(height)) * ScanMarks::kSlices);
  return std::min(ScanMarks::kSlices - 1, slice);
}

/// Whether a ray passed where returns had been. Rays above the middle of the returns may have gone
/// over the top of something that does not fill the voxel: the floor, or an obstacle so low that
/// the LiDAR no longer hits it from near. They leave it standing. Rays below the returns do so only
/// where the camera alone saw them, which samples heights densely: a table top between two rings.
bool Contradicts(const HeightNode& node, Mark mark) {
  const int top = SliceOf(0.5F * (node.low + node.high));
  const int bottom = node.by_lidar ? 0 : SliceOf(node.low);
  const int slices = (2 << top) - (1 << bottom);
  return (mark & slices) != 0;
}

}  // namespace

HeightOcTree::Cube HeightOcTree::Whole() const {
  const int half = 1 << (tree_depth - 1);
  return {Eigen::Vector3i::Constant(-half), 2 * half};
}

bool HeightOcTree::InReach(const Eigen::Vector3d& point_voxels) const {
  return (point_voxels.array().abs() < static_cast<double>((1 << (tree_depth - 1)) - 1)).all();
}

void HeightOcTree::Apply(const ScanMarks& marks, const MarkModel& model) {
  const bool first = root == nullptr;
  if (first) {
    root = new HeightNode();
    ++tree_size;
  }
  bool created = first;
  for (std::size_t block = 0; block < marks.block_count(); ++block) {
    if (!marks.Touched(block)) continue;
    if (!AnyOf(marks.MarksOf(block), ScanMarks::kBlockVoxels, kSaysSomething)) continue;
    Descend(root, created, Whole(), block, {marks, model});
    created = false;
  }
  if (created) clear();
}

/// Free already, as sure as can be, and nothing returned from it.
bool HeightOcTree::IsSettled(const HeightNode& leaf, const Mark* marks, std::size_t count) const {
  return leaf.getLogOdds() <= clamping_thres_min && !AnyOf(marks, count, ScanMarks::kHit);
}

/// Nodes lie all over the memory: asks for the children and what they point to at once, instead of
/// waiting for one after the other.
void HeightOcTree::Fetch(const HeightNode& node) {
  for (int child = 0; child < 8; ++child) __builtin_prefetch(node.children[child]);
  for (int child = 0; child < 8; ++child) {
    const auto* below = static_cast<const HeightNode*>(node.children[child]);
    if (below != nullptr) __builtin_prefetch(below->children);
  }
}

void HeightOcTree::Settle(HeightNode* node) {
  if (!pruneNode(node)) node->updateOccupancyChildren();
}

/// Down to the node of a block.
void HeightOcTree::Descend(HeightNode* node, bool created, const Cube& cube, std::size_t block,
                           const Scan& scan) {
  const Mark* marks = scan.marks.MarksOf(block);
  if (cube.side == ScanMarks::kBlockSide) {
    return Take(node, created, marks, ScanMarks::kBlockVoxels, scan);
  }
  if (!created && !nodeHasChildren(node)) {
    if (IsSettled(*node, marks, ScanMarks::kBlockVoxels)) return;
    expandNode(node);
  }
  const Eigen::Vector3i target = scan.marks.BlockAt(block) * ScanMarks::kBlockSide;
  const Eigen::Array3i upper = ((target - cube.low).array() >= cube.side / 2).cast<int>();
  const int index = upper.x() + 2 * upper.y() + 4 * upper.z();
  const auto child = static_cast<unsigned>(index);
  const bool fresh = !nodeChildExists(node, child);
  HeightNode* next = fresh ? createNodeChild(node, child) : getNodeChild(node, child);
  Descend(next, fresh, cube.Child(index), block, scan);
  Settle(node);
}

void HeightOcTree::Take(HeightNode* node, bool created, const Mark* marks, std::size_t count,
                        const Scan& scan) {
  if (count == 1) return TakeVoxel(node, created, marks, scan);
  if (!created && !nodeHasChildren(node)) {
    if (IsSettled(*node, marks, count)) return;
    expandNode(node);
  }
  if (node->children != nullptr) Fetch(*node);
  const std::size_t part = count / 8;
  for (unsigned child = 0; child < 8; ++child) {
    const Mark* below = marks + child * part;
    if (!AnyOf(below, part, kSaysSomething)) continue;
    const bool fresh = !nodeChildExists(node, child);
    HeightNode* next = fresh ? createNodeChild(node, child) : getNodeChild(node, child);
    Take(next, fresh, below, part, scan);
  }
  Settle(node);
}

/// Returns win over rays that pass.
void HeightOcTree::TakeVoxel(HeightNode* node, bool created, const Mark* mark, const Scan& scan) {
  const bool occupied = !created && isNodeOccupied(node);
  if ((*mark & ScanMarks::kHit) != 0) {
    const ScanMarks::Hit& hit = scan.marks.HitAt(scan.marks.IndexOf(mark));
    return TakeHit(node, occupied, hit, scan.model);
  }
  // Nothing ends where more stands above: it is not low, so that any ray tells that it is gone.
  const auto goes_on = [&] {
    return node->by_lidar && OccupiedAbove(scan.marks.CellAt(scan.marks.IndexOf(mark)));
  };
  if (!occupied || Contradicts(*node, *mark) || goes_on()) TakeMiss(node, scan.model);
}

bool HeightOcTree::OccupiedAbove(const Eigen::Vector3i& cell) const {
  const Eigen::Vector3i key = cell + Eigen::Vector3i(0, 0, 1) - Whole().low;
  const HeightNode* above = search(octomap::OcTreeKey(static_cast<octomap::key_type>(key.x()),
                                                      static_cast<octomap::key_type>(key.y()),
                                                      static_cast<octomap::key_type>(key.z())));
  return above != nullptr && isNodeOccupied(above);
}

/// Heights follow returns further out at once but in part, and come back slowly: noise widens them
/// little, and what is gone is forgotten.
void HeightOcTree::TakeHit(HeightNode* node, bool known, const ScanMarks::Hit& hit,
                           const MarkModel& model) {
  constexpr float kOut = 0.5F;
  constexpr float kBack = 0.15F;
  if (known) {
    node->low += (hit.low < node->low ? kOut : kBack) * (hit.low - node->low);
    node->high += (hit.high > node->high ? kOut : kBack) * (hit.high - node->high);
  } else {
    node->low = hit.low;
    node->high = hit.high;
    node->by_lidar = false;
  }
  node->by_lidar = node->by_lidar || model.lidar;
  node->setLogOdds(std::min(clamping_thres_max, node->getLogOdds() + model.hit));
}

void HeightOcTree::TakeMiss(HeightNode* node, const MarkModel& model) {
  node->setLogOdds(std::max(clamping_thres_min, node->getLogOdds() + model.miss));
  if (!isNodeOccupied(node)) node->Forget();
}

void HeightOcTree::KeepBox(const Eigen::Vector3i& low, const Eigen::Vector3i& high) {
  if (root == nullptr) return;
  if (!Keep(root, Whole(), {low, high})) clear();
}

/// False when nothing of the node lies in the box.
bool HeightOcTree::Keep(HeightNode* node, const Cube& cube, const Box& box) {
  if (!cube.Touches(box)) return false;
  if (cube.Inside(box)) return true;
  if (!nodeHasChildren(node)) expandNode(node);
  bool any = false;
  for (int index = 0; index < 8; ++index) {
    const auto child = static_cast<unsigned>(index);
    if (!nodeChildExists(node, child)) continue;
    HeightNode* below = getNodeChild(node, child);
    if (Keep(below, cube.Child(index), box)) {
      any = true;
      continue;
    }
    Empty(below);
    deleteNodeChild(node, child);
  }
  if (any) node->updateOccupancyChildren();
  return any;
}

/// Deletes all below a node.
void HeightOcTree::Empty(HeightNode* node) {
  if (node->children == nullptr) return;
  for (unsigned child = 0; child < 8; ++child) {
    if (!nodeChildExists(node, child)) continue;
    Empty(getNodeChild(node, child));
    deleteNodeChild(node, child);
  }
  delete[] node->children;  // deleteNodeChild() leaves the array
  node->children = nullptr;
}

void HeightOcTree::Visit(const Eigen::Vector3i& low, const Eigen::Vector3i& high,
                         const std::function<void(const VoxelView&)>& visit) const {
  if (root != nullptr) VisitBelow(root, Whole(), {low, high}, visit);
}

void HeightOcTree::VisitBelow(const HeightNode* node, const Cube& cube, const Box& box,
                              const std::function<void(const VoxelView&)>& visit) const {
  if (!cube.Touches(box)) return;
  if (!nodeHasChildren(node)) {
    const auto voxel = static_cast<float>(resolution);
    return visit(
        {cube.low, cube.side, isNodeOccupied(node), node->low * voxel, node->high * voxel});
  }
  Fetch(*node);
  for (int index = 0; index < 8; ++index) {
    const auto child = static_cast<unsigned>(index);
    if (!nodeChildExists(node, child)) continue;
    VisitBelow(getNodeChild(node, child), cube.Child(index), box, visit);
  }
}

}  // namespace hv::navigation
