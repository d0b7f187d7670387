#include "hv_explore_sac/policy/policy_input.h"

#include <algorithm>
#include <cmath>

namespace hv::explore {
namespace {

// Scales that bring features to size about one, in units and points of PolicyScale.
constexpr float kWay = 200.0F;
constexpr float kNeighborWay = 22.0F;
constexpr float kView = 70.0F;
constexpr float kPoints = 50.0F;
/// Beyond this logarithms and ratios are all the same.
constexpr float kMost = 3.0F;
/// Half edges of the squares in which the unknown is counted [units].
constexpr float kNear = 24.0F;
constexpr float kWide = 56.0F;
constexpr float kFar = 112.0F;
/// Edge of the squares over which it is summed up [units].
constexpr float kSumSquare = 8.0F;
/// How quickly goals matter less to each other with the way between them [1/units].
constexpr float kAroundDecay = 0.02F;
/// Free cells of a large place [units^2].
constexpr float kArea = 1e5F;

/// Distance to the nearest border of a place from the lowest cell on, negative outside [cells].
float BorderDistance(const Belief& belief, const Eigen::Vector2f& cell) {
  const float x = std::min(cell.x(), static_cast<float>(belief.width()) - cell.x());
  const float y = std::min(cell.y(), static_cast<float>(belief.height()) - cell.y());
  return std::min(x, y);
}

/// In blocks of the frontiers, of which the squares have a whole number.
int SquareOfSums(const PolicyScale& scale, int block) {
  const float blocks = kSumSquare * scale.unit / static_cast<float>(block);
  return std::max(1, static_cast<int>(std::lround(blocks)));
}

void TransformVectors(int symmetry, int vectors, nn::Matrix<float>& matrix) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (int v = 0; v < vectors; ++v) {
      float& x = matrix(i, 2 * v);
      float& y = matrix(i, 2 * v + 1);
      if ((symmetry & 1) != 0) x = -x;
      if ((symmetry & 2) != 0) y = -y;
      if ((symmetry & 4) != 0) std::swap(x, y);
    }
  }
}

}  // namespace

void PolicyInput::Build(const Observation& observation, const ExplorationModel& model,
                        const std::optional<Eigen::Vector2i>& kept, nn::GraphInput& input) {
  goals_ = &selector_.Select(observation, model);
  tours_.Plan(observation, model, *goals_);
  scale_ = PolicyScale(model.config());
  const Frontiers& frontiers = model.frontiers();
  unknown_.Count(frontiers, SquareOfSums(scale_, frontiers.block()));
  ChooseNodes(observation);
  const auto count = static_cast<Eigen::Index>(nodes_.size());
  input.features.setZero(count, kFeatures);
  input.positions.resize(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int node = nodes_[static_cast<std::size_t>(i)];
    DescribeNode(observation, model, node, input.features.row(i));
    input.positions.row(i) =
        observation.node(node).position.transpose() / (kNeighborWay * scale_.unit);
  }
  input.actions.clear();
  for (int goal = 0; goal < static_cast<int>(goals_->size()); ++goal) {
    const int row = goal + 1;
    DescribeGoal(model, goal, input.features.row(row));
    const int viewpoint = observation.node(nodes_[static_cast<std::size_t>(row)]).viewpoint;
    input.features(row, kIsKept) = model.graph().CellOf(viewpoint) == kept ? 1.0F : 0.0F;
    input.actions.push_back(row);
  }
  input.current = 0;
  JoinNodes(observation, input);
  DescribeState(observation, input);
  DescribeHistory(observation, model, input);
}

void PolicyInput::ChooseNodes(const Observation& observation) {
  nodes_.assign(1, Observation::kRobot);
  index_of_.assign(observation.nodes.size(), -1);
  index_of_[Observation::kRobot] = 0;
  for (const Goal& goal : *goals_) {
    index_of_[static_cast<std::size_t>(goal.node)] = static_cast<int>(nodes_.size());
    nodes_.push_back(goal.node);
  }
  if (!config_.ways) return;
  for (const Goal& goal : *goals_) {
    for (int at = observation.node(goal.node).predecessor; at >= 0;
         at = observation.node(at).predecessor) {
      int& index = index_of_[static_cast<std::size_t>(at)];
      if (index >= 0) continue;
      index = static_cast<int>(nodes_.size());
      nodes_.push_back(at);
    }
  }
}

void PolicyInput::JoinNodes(const Observation& observation, nn::GraphInput& input) const {
  const auto core = static_cast<int>(goals_->size()) + 1;
  input.start.assign(1, 0);
  input.neighbour.clear();
  for (int i = 0; i < static_cast<int>(nodes_.size()); ++i) {
    for (int j = 0; i < core && j < core; ++j) {
      if (j != i) input.neighbour.push_back(j);
    }
    for (const Observation::Edge& edge : observation.EdgesOf(nodes_[static_cast<std::size_t>(i)])) {
      const int j = index_of_[static_cast<std::size_t>(edge.to)];
      if (j >= 0 && (i >= core || j >= core)) input.neighbour.push_back(j);
    }
    input.start.push_back(static_cast<std::int32_t>(input.neighbour.size()));
  }
}

void PolicyInput::DescribeNode(const Observation& observation, const ExplorationModel& model,
                               int node, Row row) const {
  const Observation::Node& of = observation.node(node);
  const float way_scale = kWay * scale_.unit;
  const float points = scale_.point * static_cast<float>(of.utility);
  row[kPositionX] = of.position.x() / way_scale;
  row[kPositionY] = of.position.y() / way_scale;
  row[kIsRobot] = node == Observation::kRobot ? 1.0F : 0.0F;
  row[kVisited] = of.visited ? 1.0F : 0.0F;
  row[kUtility] = points / kPoints;
  row[kLogUtility] = std::log1p(points) / kMost;
  row[kDistance] = of.distance / way_scale;
  row[kStraightDistance] = of.position.norm() / way_scale;
  DescribeUnknown(model, of.position, of.position, row);
}

void PolicyInput::DescribeGoal(const ExplorationModel& model, int goal, Row row) const {
  const Goal& of = (*goals_)[static_cast<std::size_t>(goal)];
  const float way_scale = kWay * scale_.unit;
  const float view_scale = kView * scale_.unit;
  const Eigen::Vector2f node(row[kPositionX] * way_scale, row[kPositionY] * way_scale);
  row[kFrontierX] = (of.frontier - node).x() / view_scale;
  row[kFrontierY] = (of.frontier - node).y() / view_scale;
  row[kIsGoal] = 1.0F;
  row[kFresh] = scale_.point * static_cast<float>(of.fresh) / kPoints;
  row[kRank] = std::max(of.rank - goals_->front().rank, -kMost);
  DescribeUnknown(model, node, of.frontier, row);
  DescribeTour(goal, row);
}

void PolicyInput::DescribeTour(int goal, Row row) const {
  const float way_scale = kWay * scale_.unit;
  const float decay = kAroundDecay / scale_.unit;
  float nearest = kMost * way_scale;
  float sum = 0.0F;
  float around = 0.0F;
  float least_length = tours_.LengthVia(goal);
  float most_gain = tours_.GainVia(goal);
  for (int other = 0; other < tours_.size(); ++other) {
    least_length = std::min(least_length, tours_.LengthVia(other));
    most_gain = std::max(most_gain, tours_.GainVia(other));
    if (other == goal) continue;
    const float way = tours_.Between(goal, other);
    nearest = std::min(nearest, way);
    sum += way;
    around += static_cast<float>((*goals_)[static_cast<std::size_t>(other)].fresh) *
              std::exp(-decay * way);
  }
  row[kNearestGoal] = nearest / way_scale;
  row[kMeanGoal] = sum / (way_scale * static_cast<float>(std::max(1, tours_.size() - 1)));
  row[kGoalsAround] = scale_.point * around / kPoints;
  row[kTourExcess] = std::min((tours_.LengthVia(goal) - least_length) / way_scale, kMost);
  row[kTourGain] = std::max(std::log(tours_.GainVia(goal) / most_gain), -kMost);
}

void PolicyInput::DescribeUnknown(const ExplorationModel& model, const Eigen::Vector2f& node,
                                  const Eigen::Vector2f& place, Row row) const {
  const Eigen::Vector2i robot = model.graph().CellOf(model.robot()) - model.belief().low();
  const Eigen::Vector2f cell = place + robot.cast<float>();
  const Eigen::Vector2f ahead = (place - node).normalized();
  const float wide = kWide * scale_.unit;
  const float far = kFar * scale_.unit;
  row[kUnknownNear] = unknown_.Around(cell, kNear * scale_.unit);
  row[kUnknownWide] = unknown_.Around(cell, wide);
  row[kUnknownFar] = unknown_.Around(cell, far);
  row[kUnknownAhead] = unknown_.Around(cell + wide * ahead, wide);
  row[kUnknownFarAhead] = unknown_.Around(cell + far * ahead, far);
  row[kBorder] = std::min(BorderDistance(model.belief(), cell) / far, kMost);
}

void PolicyInput::DescribeState(const Observation& observation, nn::GraphInput& input) const {
  float shortest = tours_.LengthVia(0);
  float points = 0.0F;
  for (int goal = 0; goal < tours_.size(); ++goal) {
    shortest = std::min(shortest, tours_.LengthVia(goal));
    points += static_cast<float>((*goals_)[static_cast<std::size_t>(goal)].fresh);
  }
  input.globals.resize(kGlobals);
  const float area = kArea * scale_.unit * scale_.unit;
  input.globals << unknown_.Everywhere(), static_cast<float>(observation.explored) / area,
      static_cast<float>(tours_.size()) / static_cast<float>(GoalTours::kMostGoals),
      scale_.point * points / (4.0F * kPoints), shortest / (4.0F * kWay * scale_.unit),
      goals_->front().rank / kMost;
}

void PolicyInput::DescribeHistory(const Observation& observation, const ExplorationModel& model,
                                  nn::GraphInput& input) const {
  const std::vector<int>& history = observation.history;
  const std::size_t window = std::min(kHistory, history.size());
  input.history.setZero(static_cast<Eigen::Index>(window), kFeatures);
  for (std::size_t i = 0; i < window; ++i) {
    DescribeNode(observation, model, history[history.size() - window + i],
                 input.history.row(static_cast<Eigen::Index>(i)));
  }
}

void Transform(int symmetry, nn::GraphInput& input) {
  TransformVectors(symmetry, PolicyInput::kVectors, input.features);
  TransformVectors(symmetry, PolicyInput::kVectors, input.history);
  TransformVectors(symmetry, 1, input.positions);
}

}  // namespace hv::explore
