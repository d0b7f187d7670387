#include "hv_relocalize_ndt/pose_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "hv_core/angles.h"

namespace hv::relocalize {
namespace {

/// Nodes opened at once, and rated by one thread at least.
constexpr std::size_t kBatch = 64;
constexpr std::size_t kPoseGrain = 32;

/// The scan at one heading, as cubes relative to that of the sensor.
struct TurnedScan {
  double yaw = 0.0;
  std::vector<Eigen::Vector3i> offsets;
  std::vector<StructureBits> fits;
};

/// Poses with sensor cubes [cell, cell + 2^level) at one heading.
struct Node {
  float bound = 0.0F;
  std::uint32_t turn = 0;
  int level = 0;
  Eigen::Vector3i cell = Eigen::Vector3i::Zero();

  /// Best first; of equals the finer, then in a fixed order.
  bool operator<(const Node& other) const {
    if (bound != other.bound) return bound < other.bound;
    if (level != other.level) return level > other.level;
    if (turn != other.turn) return turn > other.turn;
    return std::lexicographical_compare(other.cell.data(), other.cell.data() + 3, cell.data(),
                                        cell.data() + 3);
  }
};

/// At most `limit` of the items in reach, evenly.
std::vector<StructureCell> Sample(std::vector<StructureCell> cells, std::size_t limit) {
  if (cells.size() <= limit) return cells;
  std::vector<StructureCell> sample;
  for (std::size_t k = 0; k < limit; ++k) sample.push_back(cells[k * cells.size() / limit]);
  return sample;
}

class Search {
 public:
  Search(const PoseSearchConfig& config, const StructureGrid& grid,
         const std::vector<StructureCell>& scan, const PoseWindow& window)
      : config_(config), grid_(grid) {
    ChooseCells(scan);
    low_ = grid.CellOf(window.low).cwiseMax(-Eigen::Vector3i::Ones());
    high_ = grid.CellOf(window.high).cwiseMin(grid.size());
    Turn(window);
  }

  /// Best first. Several nodes are opened at once, so that threads have work; what they find is
  /// taken in order of score, as if they had been opened one by one.
  std::vector<PoseHypothesis> Run() {
    std::vector<PoseHypothesis> found;
    if (cells_.empty()) return found;
    std::priority_queue<Node> open(std::less<Node>(), Roots());
    int visited = 0;
    while (!open.empty() && found.size() < static_cast<std::size_t>(config_.max_hypotheses)) {
      const double best = found.empty() ? 0.0 : found.front().score;
      const double least = std::max(config_.min_score, config_.min_score_share * best);
      if (open.top().bound <= least || visited > config_.max_nodes) break;
      if (open.top().level == 0) {
        const PoseHypothesis hypothesis = HypothesisOf(open.top());
        open.pop();
        if (!Known(hypothesis, found)) found.push_back(hypothesis);
        continue;
      }
      std::vector<Node> batch;
      while (!open.empty() && open.top().level > 0 && batch.size() < kBatch) {
        batch.push_back(open.top());
        open.pop();
      }
      visited += static_cast<int>(batch.size());
      for (const Node& child : ChildrenOf(batch, least)) {
        if (child.bound > least) open.push(child);
      }
    }
    return found;
  }

 private:
  /// What stands upright tells places apart; floors and ceilings fix the height.
  void ChooseCells(const std::vector<StructureCell>& scan) {
    std::vector<StructureCell> upright;
    std::vector<StructureCell> level;
    for (const StructureCell& cell : scan) {
      if (cell.center.head<2>().norm() > config_.max_range_m) continue;
      (cell.level ? level : upright).push_back(cell);
    }
    if (upright.empty()) return;
    const auto most = static_cast<std::size_t>(config_.max_cells);
    cells_ = Sample(std::move(upright), most);
    upright_ = cells_.size();
    const std::vector<StructureCell> floors = Sample(std::move(level), most / 4);
    cells_.insert(cells_.end(), floors.begin(), floors.end());
    const double level_share = floors.empty() ? 0.0 : config_.level_share;
    upright_weight_ = static_cast<float>((1.0 - level_share) / static_cast<double>(upright_));
    if (!floors.empty()) {
      level_weight_ = static_cast<float>(level_share / static_cast<double>(floors.size()));
    }
  }

  void Turn(const PoseWindow& window) {
    double reach = grid_.cell_m();
    for (const StructureCell& cell : cells_) {
      reach = std::max(reach, static_cast<double>(cell.center.head<2>().norm()));
    }
    const double step = 1.4 * grid_.cell_m() / reach;
    const int half = static_cast<int>(std::ceil(window.yaw_range_rad / step));
    const bool all = window.yaw_range_rad > 3.14;
    for (int k = -half; k <= half - (all ? 1 : 0); ++k) {
      const double spacing = half > 0 ? window.yaw_range_rad / half : 0.0;
      turns_.push_back(TurnedBy(window.yaw_rad + k * spacing));
    }
  }

  TurnedScan TurnedBy(double yaw) const {
    TurnedScan turned;
    turned.yaw = yaw;
    const Eigen::Matrix3f rotation =
        Eigen::AngleAxisf(static_cast<float>(yaw), Eigen::Vector3f::UnitZ()).toRotationMatrix();
    const auto inverse_cell = static_cast<float>(1.0 / grid_.cell_m());
    for (const StructureCell& cell : cells_) {
      const Eigen::Vector3f place =
          inverse_cell * (rotation * cell.center) + Eigen::Vector3f::Constant(0.5F);
      turned.offsets.push_back(place.array().floor().cast<int>());
      turned.fits.push_back(cell.Fits(static_cast<float>(yaw)));
    }
    return turned;
  }

  /// Exact above `least`; else as soon as it is known to be below.
  float Bound(const Node& node, float least) const {
    constexpr std::size_t kStride = 32;
    const TurnedScan& scan = turns_[node.turn];
    const auto missing = [&](std::size_t begin, std::size_t end) {
      int missed = 0;
      for (std::size_t i = begin; i < end; ++i) {
        missed += (grid_.At(node.level, node.cell + scan.offsets[i]) & scan.fits[i]) == 0 ? 1 : 0;
      }
      return static_cast<float>(missed);
    };
    float bound = 1.0F;
    for (std::size_t i = 0; i < upright_ && bound > least; i += kStride) {
      bound -= upright_weight_ * missing(i, std::min(i + kStride, upright_));
    }
    return bound > least ? bound - level_weight_ * missing(upright_, cells_.size()) : bound;
  }

  /// Fills in the bounds.
  void Rate(std::vector<Node>& nodes, double least) const {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, nodes.size(), kPoseGrain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i < range.end(); ++i) {
                          nodes[i].bound = Bound(nodes[i], static_cast<float>(least));
                        }
                      });
  }

  std::vector<Node> Roots() const {
    const int level = grid_.depth() - 1;
    const int width = 1 << level;
    std::vector<Node> roots;
    for (std::uint32_t turn = 0; turn < turns_.size(); ++turn) {
      for (int z = low_.z(); z <= high_.z(); z += width) {
        for (int y = low_.y(); y <= high_.y(); y += width) {
          for (int x = low_.x(); x <= high_.x(); x += width) {
            const Node root{0.0F, turn, level, {x, y, z}};
            if (grid_.CanStand(level, root.cell)) roots.push_back(root);
          }
        }
      }
    }
    Rate(roots, config_.min_score);
    return roots;
  }

  std::vector<Node> ChildrenOf(const std::vector<Node>& nodes, double least) const {
    std::vector<Node> children;
    for (const Node& node : nodes) {
      const int half = 1 << (node.level - 1);
      for (int corner = 0; corner < 8; ++corner) {
        Node child = node;
        child.level = node.level - 1;
        child.cell += half * Eigen::Vector3i(corner & 1, (corner >> 1) & 1, corner >> 2);
        const bool inside = (child.cell.array() <= high_.array()).all();
        if (inside && grid_.CanStand(child.level, child.cell)) children.push_back(child);
      }
    }
    Rate(children, least);
    return children;
  }

  PoseHypothesis HypothesisOf(const Node& node) const {
    PoseHypothesis hypothesis;
    hypothesis.score = node.bound;
    const Eigen::Vector3d center = node.cell.cast<double>() + Eigen::Vector3d::Constant(0.5);
    hypothesis.T_map_level = MakePose(RotationFromRpy(0.0, 0.0, turns_[node.turn].yaw),
                                      grid_.origin() + grid_.cell_m() * center);
    return hypothesis;
  }

  bool Known(const PoseHypothesis& one, const std::vector<PoseHypothesis>& found) const {
    return std::any_of(found.begin(), found.end(), [&](const PoseHypothesis& other) {
      return (one.T_map_level.translation() - other.T_map_level.translation()).norm() <
                 config_.same_place_m &&
             RotationDistance(one.T_map_level, other.T_map_level) * kDegreesPerRadian <
                 config_.same_heading_deg;
    });
  }

  const PoseSearchConfig& config_;
  const StructureGrid& grid_;
  std::vector<StructureCell> cells_;  ///< upright ones first
  std::size_t upright_ = 0;
  float upright_weight_ = 0.0F;
  float level_weight_ = 0.0F;
  Eigen::Vector3i low_ = Eigen::Vector3i::Zero();
  Eigen::Vector3i high_ = Eigen::Vector3i::Zero();
  std::vector<TurnedScan> turns_;
};

}  // namespace

void PoseSearchConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("cell_m", cell_m, "step of positions, edge of the cubes compared [m]");
  visitor.Field("depth", depth, "levels of the search, the coarsest of 2^(depth-1) cubes");
  visitor.Field("max_range_m", max_range_m, "how far around the scan structure is compared [m]");
  visitor.Field("max_cells", max_cells, "cubes of the scan that are compared");
  visitor.Field("level_share", level_share, "weight of floors and ceilings, 0 to 1");
  visitor.Field("max_hypotheses", max_hypotheses, "poses that are followed up");
  visitor.Field("min_score", min_score,
                "share of the scan's structure that the map must hold at these, 0 to 1");
  visitor.Field("min_score_share", min_score_share,
                "score that these need, share of the best one's, 0 to 1");
  visitor.Field("same_place_m", same_place_m, "distance up to which two poses are the same [m]");
  visitor.Field("same_heading_deg", same_heading_deg, "and difference of heading [deg]");
  visitor.Field("max_nodes", max_nodes, "regions of poses after which the search ends");
}

void PoseSearchConfig::Validate(ConfigProblems& problems) const {
  problems.Require(cell_m > 0.0, "search.cell_m", "must be positive");
  problems.Require(depth >= 1 && depth <= 8, "search.depth", "must lie between 1 and 8");
  problems.Require(max_range_m > 0.0, "search.max_range_m", "must be positive");
  problems.Require(max_cells >= 1, "search.max_cells", "must be at least 1");
  problems.Require(level_share >= 0.0 && level_share < 1.0, "search.level_share",
                   "must be at least 0 and less than 1");
  problems.Require(max_hypotheses >= 1, "search.max_hypotheses", "must be at least 1");
  problems.Require(min_score >= 0.0 && min_score < 1.0, "search.min_score",
                   "must be at least 0 and less than 1");
  problems.Require(min_score_share >= 0.0 && min_score_share < 1.0, "search.min_score_share",
                   "must be at least 0 and less than 1");
  problems.Require(same_place_m >= 0.0, "search.same_place_m", "must not be negative");
  problems.Require(same_heading_deg >= 0.0, "search.same_heading_deg", "must not be negative");
  problems.Require(max_nodes >= 1, "search.max_nodes", "must be at least 1");
}

std::vector<PoseHypothesis> PoseSearch::Find(const std::vector<StructureCell>& scan,
                                             const PoseWindow& window) const {
  return Search(config_, grid_, scan, window).Run();
}

}  // namespace hv::relocalize
