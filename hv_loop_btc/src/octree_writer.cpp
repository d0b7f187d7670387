#include "octree_writer.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <unordered_set>

#include <octomap/octomap.h>

#include "hv_core/error.h"

namespace hv::loop {
namespace {

enum class State : std::uint8_t { kUnknown, kFree, kOccupied };

/// A tree that starts with its root: OctoMap offers no other way to insert whole cubes.
class RootedOcTree : public octomap::OcTree {
 public:
  explicit RootedOcTree(double voxel_m) : octomap::OcTree(voxel_m) {
    root = new octomap::OcTreeNode();
    ++tree_size;
    size_changed = true;
  }
};

/// Puts blocks into a tree, uniform cubes as one node: memory stays that of the pruned tree.
class OcTreeFiller {
 public:
  explicit OcTreeFiller(const VoxelSpace& space) : tree_(space.voxel_m()) {
    for (const Surface& surface : space.surfaces()) {
      if (surface.moving) moving_.insert(KeyOf(surface.voxel));
    }
  }

  void Add(const Block& block) {
    const VoxelIndex corner = block.index * Block::kSide;
    const int reach = 1 << (kDepth - 1);
    if ((corner.array() < -reach).any() || (corner.array() + Block::kSide > reach).any()) return;
    ReadStates(block);
    if (IsUniform(Eigen::Vector3i::Zero(), Block::kSide) && states_[0] == State::kUnknown) return;
    const octomap::OcTreeKey key(ToKey(corner.x()), ToKey(corner.y()), ToKey(corner.z()));
    Fill(Descend(key), Eigen::Vector3i::Zero(), Block::kSide);
  }

  /// The header is OctoMap's own; its writeBinary() may print to the console and hides failures.
  void Write(const std::string& path) {
    tree_.toMaxLikelihood();
    tree_.prune();
    std::ofstream file(path, std::ios::binary);
    file << "# Octomap OcTree binary file\nid OcTree\nsize " << tree_.size() << "\nres "
         << tree_.getResolution() << "\ndata\n";
    tree_.writeBinaryNode(file, tree_.getRoot());
    file.close();
    if (!file) throw InputError(path + ": cannot be written");
  }

 private:
  static constexpr int kDepth = 16;

  static octomap::key_type ToKey(int index) {
    return static_cast<octomap::key_type>(index + (1 << (kDepth - 1)));
  }

  void ReadStates(const Block& block) {
    for (int i = 0; i < Block::kSide * Block::kSide * Block::kSide; ++i) {
      const auto bit = static_cast<std::size_t>(i);
      states_[bit] = block.free.test(bit) ? State::kFree : State::kUnknown;
      if (!block.hit.test(bit)) continue;
      const VoxelIndex within(i % Block::kSide, i / Block::kSide % Block::kSide,
                              i / (Block::kSide * Block::kSide));
      const bool moving = moving_.count(KeyOf(block.index * Block::kSide + within)) != 0;
      states_[bit] = moving ? State::kFree : State::kOccupied;
    }
  }

  State StateAt(const Eigen::Vector3i& v) const { return states_[Block::Bit(v.x(), v.y(), v.z())]; }

  bool IsUniform(const Eigen::Vector3i& corner, int side) const {
    const State state = StateAt(corner);
    for (int i = 1; i < side * side * side; ++i) {
      const Eigen::Vector3i step(i % side, i / side % side, i / (side * side));
      if (StateAt(corner + step) != state) return false;
    }
    return true;
  }

  /// Node of the block at `key`, made with its parents where it is missing.
  octomap::OcTreeNode* Descend(const octomap::OcTreeKey& key) {
    octomap::OcTreeNode* node = tree_.getRoot();
    for (int level = kDepth - 1; level >= Block::kBits; --level) {
      node = Child(node, octomap::computeChildIdx(key, level));
    }
    return node;
  }

  octomap::OcTreeNode* Child(octomap::OcTreeNode* node, unsigned int index) {
    return tree_.nodeChildExists(node, index) ? tree_.getNodeChild(node, index)
                                              : tree_.createNodeChild(node, index);
  }

  void Fill(octomap::OcTreeNode* node, const Eigen::Vector3i& corner, int side) {
    if (side == 1 || IsUniform(corner, side)) {
      node->setLogOdds(StateAt(corner) == State::kOccupied ? tree_.getClampingThresMaxLog()
                                                           : tree_.getClampingThresMinLog());
      return;
    }
    const int half = side / 2;
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3i octant = corner + half * Eigen::Vector3i(i & 1, i >> 1 & 1, i >> 2 & 1);
      if (StateAt(octant) == State::kUnknown && IsUniform(octant, half)) continue;
      Fill(Child(node, static_cast<unsigned int>(i)), octant, half);
    }
  }

  RootedOcTree tree_;
  std::unordered_set<std::uint64_t> moving_;
  std::array<State, Block::kVoxels> states_{};
};

}  // namespace

void WriteOcTree(const VoxelSpace& space, const std::string& path) {
  OcTreeFiller filler(space);
  for (const auto& block : space.blocks()) filler.Add(*block);
  filler.Write(path);
}

}  // namespace hv::loop
