#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <tsl/robin_map.h>
#include <Eigen/Core>

#include "hv_explore_sac/belief.h"
#include "hv_explore_sac/exploration_config.h"

namespace hv::explore {

/// Viewpoints in known free space and the edges between them (paper, section 3.3.1): samples of a
/// uniform lattice through cell (0, 0), and the places that were added. Edges lead from a viewpoint
/// to those of its nearest ones to which the straight line is known to be free. Viewpoints are
/// named by a number that stays theirs until free space is lost. Cheap to copy: runs are tried on
/// copies. Not thread-safe.
class ViewpointGraph {
 public:
  ViewpointGraph(const ViewpointConfig& config, const Belief& belief);

  /// Takes over `belief.changes()`; the graph is then the same as one made anew from the belief, up
  /// to the order of the viewpoints. Loss of free space renumbers them.
  void Update(const Belief& belief);

  /// The viewpoint at a free cell, made if there is none.
  int Add(const Eigen::Vector2i& cell, const Belief& belief);

  /// The viewpoint at a cell, or -1.
  int At(const Eigen::Vector2i& cell) const;

  struct Edge {
    int to;
    float length;  ///< Euclidean (Eq. 12) [cells]
  };
  int size() const { return static_cast<int>(cells_.size()); }
  const Eigen::Vector2i& CellOf(int viewpoint) const { return cells_[Index(viewpoint)]; }
  /// By increasing length.
  const std::vector<Edge>& EdgesOf(int viewpoint) const { return edges_[Index(viewpoint)]; }

  bool Visited(int viewpoint) const { return visited_[Index(viewpoint)]; }
  void MarkVisited(int viewpoint) { visited_[Index(viewpoint)] = true; }

  /// How often viewpoints were renumbered.
  int renumberings() const { return renumberings_; }

 private:
  struct Neighbor {
    int distance2;  ///< squared [cells^2]
    int place;      ///< index of the cell, which settles ties whatever the order of insertion
    int viewpoint;
    int blocked;  ///< a cell in the way, or Belief::kNone
  };
  static std::size_t Index(int viewpoint) { return static_cast<std::size_t>(viewpoint); }
  bool OnLattice(int place) const { return (*on_lattice_)[Index(place)] != 0; }
  void Rebuild(const Belief& belief);
  int Insert(const Eigen::Vector2i& cell, const Belief& belief);
  void Offer(int viewpoint, Neighbor neighbor, const Belief& belief);
  void RecheckEdges(const Belief& belief);
  void ListEdges(int viewpoint);
  std::pair<Eigen::Vector2i, Eigen::Vector2i> LineBetween(int first, int second,
                                                          const Belief& belief) const;

  ViewpointConfig config_;
  Eigen::Vector2i low_;
  int width_;
  std::shared_ptr<const std::vector<char>> on_lattice_;  ///< of each cell; copies share it
  tsl::robin_map<int, int> viewpoint_at_;                ///< by index of the cell
  std::vector<Eigen::Vector2i> cells_;
  std::vector<char> visited_;
  std::vector<std::vector<Neighbor>> nearest_;  ///< sorted, at most config_.neighbors
  std::vector<std::vector<Edge>> edges_;
  std::vector<char> stale_;  ///< edges_ no longer follow nearest_
  int renumberings_ = 0;
};

}  // namespace hv::explore
