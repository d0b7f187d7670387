#pragma once

#include <functional>
#include <string>

#include <octomap/OcTreeNode.h>
#include <octomap/OccupancyOcTreeBase.h>
#include <Eigen/Core>

#include "hv_navigation/obstacle_map.h"
#include "scan_marks.h"

namespace hv::navigation {

class HeightOcTree;

/// A voxel that knows at which heights returns lay in it.
class HeightNode : public octomap::OcTreeNode {
 public:
  friend class HeightOcTree;

  bool operator==(const HeightNode& other) const {
    return value == other.value && low == other.low && high == other.high &&
           by_lidar == other.by_lidar;
  }
  void copyData(const HeightNode& from) {
    octomap::OcTreeNode::copyData(from);
    low = from.low;
    high = from.high;
    by_lidar = from.by_lidar;
  }
  void Forget() {
    low = high = 0.0F;
    by_lidar = false;
  }

  float low = 0.0F;       ///< in voxels, of occupied voxels
  float high = 0.0F;      ///< in voxels
  bool by_lidar = false;  ///< a LiDAR saw it, not only the camera
};

/// How a scan changes the voxels that it marks.
struct MarkModel {
  float hit = 0.0F;   ///< change of log-odds
  float miss = 0.0F;  ///< change of log-odds
  bool lidar = true;
};

/// Octree that takes over a whole scan branch by branch, and forgets what lies outside of a box.
/// Cells count from the origin of the frame.
class HeightOcTree : public octomap::OccupancyOcTreeBase<HeightNode> {
 public:
  explicit HeightOcTree(double voxel_m) : octomap::OccupancyOcTreeBase<HeightNode>(voxel_m) {}
  HeightOcTree* create() const override { return new HeightOcTree(resolution); }
  /// As a binary file it is an ordinary tree.
  std::string getTreeType() const override { return "OcTree"; }

  void Apply(const ScanMarks& marks, const MarkModel& model);

  /// Drops all voxels outside; the corners are multiples of a block's side.
  void KeepBox(const Eigen::Vector3i& low, const Eigen::Vector3i& high);

  /// Leaves that touch the box, in the order of the octree.
  void Visit(const Eigen::Vector3i& low, const Eigen::Vector3i& high,
             const std::function<void(const VoxelView&)>& visit) const;

  bool InReach(const Eigen::Vector3d& point_voxels) const;

 private:
  struct Scan {
    const ScanMarks& marks;
    const MarkModel& model;
  };
  struct Box {
    Eigen::Vector3i low;
    Eigen::Vector3i high;
  };
  struct Cube {
    Eigen::Vector3i low;
    int side;

    Cube Child(int index) const {
      const int half = side / 2;
      return {low + half * Eigen::Vector3i(index & 1, (index >> 1) & 1, (index >> 2) & 1), half};
    }
    bool Touches(const Box& box) const {
      return (low.array() < box.high.array()).all() && (low.array() + side > box.low.array()).all();
    }
    bool Inside(const Box& box) const {
      return (low.array() >= box.low.array()).all() &&
             (low.array() + side <= box.high.array()).all();
    }
  };

  Cube Whole() const;
  bool IsSettled(const HeightNode& leaf, const ScanMarks::Mark* marks, std::size_t count) const;
  void Descend(HeightNode* node, bool created, const Cube& cube, std::size_t block,
               const Scan& scan);
  void Take(HeightNode* node, bool created, const ScanMarks::Mark* marks, std::size_t count,
            const Scan& scan);
  void TakeVoxel(HeightNode* node, bool created, const ScanMarks::Mark* mark, const Scan& scan);
  bool OccupiedAbove(const Eigen::Vector3i& cell) const;
  void TakeHit(HeightNode* node, bool known, const ScanMarks::Hit& hit, const MarkModel& model);
  void TakeMiss(HeightNode* node, const MarkModel& model);
  void Empty(HeightNode* node);
  bool Keep(HeightNode* node, const Cube& cube, const Box& box);
  void VisitBelow(const HeightNode* node, const Cube& cube, const Box& box,
                  const std::function<void(const VoxelView&)>& visit) const;
  static void Fetch(const HeightNode& node);
  void Settle(HeightNode* node);
};

}  // namespace hv::navigation
