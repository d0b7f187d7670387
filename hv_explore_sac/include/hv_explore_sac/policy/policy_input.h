#pragma once

#include <optional>
#include <vector>

#include "hv_explore_sac/exploration_model.h"
#include "hv_explore_sac/nn/graph_sample.h"
#include "hv_explore_sac/observation.h"
#include "hv_explore_sac/policy/goal_tours.h"
#include "hv_explore_sac/policy/goals.h"
#include "hv_explore_sac/policy/policy_scale.h"
#include "hv_explore_sac/policy/unknown_share.h"

namespace hv::explore {

/// Turns an observation into what the network reads: the robot's node, the goals as the actions, on
/// request the viewpoints on the ways to them, and the viewpoints visited last. Robot and goals are
/// all joined to each other, since what one goal is worth depends on all others. What is read is
/// the same whatever the size of cells, blocks and views (PolicyScale). Not thread-safe.
class PolicyInput {
 public:
  /// Columns of the features of a node. The first are vectors (x, y), which turn with the map.
  enum Feature {
    kPositionX,  ///< relative to the robot
    kPositionY,
    kFrontierX,  ///< of a goal: from it to its frontier points
    kFrontierY,
    kIsRobot,
    kIsGoal,
    kIsKept,  ///< the goal that the robot has
    kVisited,
    kUtility,
    kLogUtility,
    kFresh,
    kDistance,          ///< of the way
    kStraightDistance,  ///< as the crow flies
    kRank,              ///< below the goal that `utility` would choose
    kUnknownNear,       ///< around the frontier points, or around what is no goal
    kUnknownWide,
    kUnknownFar,
    kUnknownAhead,  ///< beyond the frontier points
    kUnknownFarAhead,
    kBorder,       ///< distance to the border of the belief
    kNearestGoal,  ///< way to the nearest other goal
    kMeanGoal,     ///< mean of the ways to the other goals
    kGoalsAround,  ///< what other goals observe, less with the way to them
    kTourExcess,   ///< tour through all goals, this one first, beyond the shortest
    kTourGain,     ///< log of what such a tour gains, below the best
    kFeatures
  };
  static constexpr int kVectors = 2;
  static constexpr int kGlobals = 6;
  static constexpr std::size_t kHistory = 16;  ///< viewpoints visited last

  explicit PolicyInput(const PolicyConfig& config) : config_(config), selector_(config) {}

  /// `kept` is the cell of the goal that the robot has, if any. The actions of `input` stand for
  /// goals(), in the same order.
  void Build(const Observation& observation, const ExplorationModel& model,
             const std::optional<Eigen::Vector2i>& kept, nn::GraphInput& input);
  const std::vector<Goal>& goals() const { return *goals_; }

 private:
  using Row = Eigen::Ref<Eigen::RowVectorXf>;
  void ChooseNodes(const Observation& observation);
  void JoinNodes(const Observation& observation, nn::GraphInput& input) const;
  void DescribeNode(const Observation& observation, const ExplorationModel& model, int node,
                    Row row) const;
  void DescribeGoal(const ExplorationModel& model, int goal, Row row) const;
  void DescribeTour(int goal, Row row) const;
  void DescribeUnknown(const ExplorationModel& model, const Eigen::Vector2f& node,
                       const Eigen::Vector2f& place, Row row) const;
  void DescribeState(const Observation& observation, nn::GraphInput& input) const;
  void DescribeHistory(const Observation& observation, const ExplorationModel& model,
                       nn::GraphInput& input) const;

  PolicyConfig config_;
  GoalSelector selector_;
  GoalTours tours_;
  UnknownShare unknown_;
  PolicyScale scale_{ExplorationConfig()};  ///< of the belief that was last read
  const std::vector<Goal>* goals_ = nullptr;
  std::vector<int> nodes_;     ///< of the observation: the robot's, the goals', those on the ways
  std::vector<int> index_of_;  ///< of each node of the observation in `nodes_`, or -1
};

constexpr int kSymmetries = 8;
/// The same state in a map that is turned by quarters and mirrored, `symmetry` in [0, kSymmetries).
void Transform(int symmetry, nn::GraphInput& input);

}  // namespace hv::explore
