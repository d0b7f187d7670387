#include "tree_search.h"

#include <algorithm>
#include <memory>
#include <random>
#include <utility>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

namespace hv::navigation {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

using StateType = ob::SE2StateSpace::StateType;

PlanarPose PoseOf(const ob::State* state) {
  const auto* pose = state->as<StateType>();
  return {{pose->getX(), pose->getY()}, pose->getYaw()};
}

void SetPose(ob::State* state, const PlanarPose& pose) {
  state->as<StateType>()->setXY(pose.position.x(), pose.position.y());
  state->as<StateType>()->setYaw(WrappedAngle(pose.yaw));
}

/// Poses joined by turn, drive, turn.
class DriveSpace : public ob::SE2StateSpace {
 public:
  explicit DriveSpace(double turn_cost_m) : turn_cost_m_(turn_cost_m) {}

  /// Not above the cost of the motion, and a metric, as the search for neighbours wants it.
  double distance(const ob::State* a, const ob::State* b) const override {
    const PlanarPose from = PoseOf(a);
    const PlanarPose to = PoseOf(b);
    return (to.position - from.position).norm() +
           turn_cost_m_ * std::abs(WrappedAngle(to.yaw - from.yaw));
  }

  void interpolate(const ob::State* a, const ob::State* b, double t,
                   ob::State* state) const override {
    const PlanarPose from = PoseOf(a);
    const PlanarPose to = PoseOf(b);
    const TurnDriveTurn motion = Between(from, to);
    PlanarPose pose = t >= 1.0 ? to : from;
    if (t > 0.0 && t < 1.0) {
      pose.position += t * (to.position - from.position);
      pose.yaw = motion.heading;
    }
    SetPose(state, pose);
  }

  bool hasSymmetricInterpolate() const override { return false; }

 private:
  double turn_cost_m_;
};

class DriveValidator : public ob::MotionValidator {
 public:
  DriveValidator(const ob::SpaceInformationPtr& info, const FreeSpace& space)
      : ob::MotionValidator(info), space_(space) {}

  bool checkMotion(const ob::State* a, const ob::State* b) const override {
    return space_.MotionIsFree(PoseOf(a), PoseOf(b));
  }
  bool checkMotion(const ob::State* a, const ob::State* b,
                   std::pair<ob::State*, double>& last_valid) const override {
    last_valid.second = 0.0;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, a);
    return checkMotion(a, b);
  }

 private:
  const FreeSpace& space_;
};

class DriveObjective : public ob::OptimizationObjective {
 public:
  DriveObjective(const ob::SpaceInformationPtr& info, const FreeSpace& space, double turn_cost_m)
      : ob::OptimizationObjective(info), space_(space), turn_cost_m_(turn_cost_m) {}

  ob::Cost stateCost(const ob::State* /*state*/) const override { return identityCost(); }

  ob::Cost motionCost(const ob::State* a, const ob::State* b) const override {
    const PlanarPose from = PoseOf(a);
    const PlanarPose to = PoseOf(b);
    const TurnDriveTurn motion = Between(from, to);
    const double turns = std::abs(motion.first_turn) + std::abs(motion.last_turn);
    return ob::Cost(space_.DriveCost(from.position, to.position) + turn_cost_m_ * turns);
  }

  ob::Cost motionCostHeuristic(const ob::State* a, const ob::State* b) const override {
    return ob::Cost(si_->distance(a, b));
  }

  bool isSymmetric() const override { return false; }

 private:
  const FreeSpace& space_;
  double turn_cost_m_;
};

/// First the guide itself, then poses around it, some anywhere.
class TubeSampler : public ob::StateSampler {
 public:
  TubeSampler(const ob::StateSpace* space, const std::vector<PlanarPose>& guide,
              const GlobalPlannerConfig& config)
      : ob::StateSampler(space),
        guide_(guide),
        tube_m_(config.tube_m),
        uniform_share_(config.uniform_share),
        random_(static_cast<std::mt19937::result_type>(config.seed)) {}

  void sampleUniform(ob::State* state) override {
    if (++drawn_ <= guide_.size()) return SetPose(state, guide_[drawn_ - 1]);
    const double draw = uniform_(random_);
    if (draw < uniform_share_) return SampleAnywhere(state);
    // The goal joins the tree by being drawn only; the guide may not have led there.
    constexpr double kGoalShare = 0.02;
    constexpr double kEndShare = 0.1;
    if (draw < uniform_share_ + kGoalShare) return SetPose(state, guide_.back());
    if (draw < uniform_share_ + kGoalShare + kEndShare) return SampleEnd(state);
    SampleTube(state);
  }
  void sampleUniformNear(ob::State* state, const ob::State* /*near*/, double /*far*/) override {
    sampleUniform(state);
  }
  void sampleGaussian(ob::State* state, const ob::State* /*mean*/, double /*sigma*/) override {
    sampleUniform(state);
  }

 private:
  void SampleAnywhere(ob::State* state) {
    const ob::RealVectorBounds& bounds = space_->as<ob::SE2StateSpace>()->getBounds();
    PlanarPose pose;
    for (unsigned i = 0; i < 2; ++i) {
      pose.position[i] = bounds.low[i] + uniform_(random_) * (bounds.high[i] - bounds.low[i]);
    }
    pose.yaw = M_PI * (2.0 * uniform_(random_) - 1.0);
    SetPose(state, pose);
  }

  /// Straight ahead of the start or behind the goal, where there may be no room to turn.
  void SampleEnd(ob::State* state) {
    constexpr double kFarthest_m = 1.2;
    constexpr double kSpread = 0.15;
    const bool start = uniform_(random_) < 0.5;
    const double along_m = kFarthest_m * uniform_(random_);
    const PlanarPose off{{start ? along_m : -along_m, kSpread * along_m * normal_(random_)},
                         kSpread * normal_(random_)};
    SetPose(state, (start ? guide_.front() : guide_.back()) * off);
  }

  void SampleTube(ob::State* state) {
    constexpr double kYawSigma = 0.3;
    const double at = uniform_(random_) * static_cast<double>(guide_.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(at), guide_.size() - 1);
    const std::size_t next = std::min(i + 1, guide_.size() - 1);
    const Eigen::Vector2d way = guide_[next].position - guide_[i].position;
    PlanarPose pose;
    pose.position = guide_[i].position + (at - static_cast<double>(i)) * way;
    pose.position.x() += tube_m_ * normal_(random_);
    pose.position.y() += tube_m_ * normal_(random_);
    pose.yaw = guide_[i].yaw + kYawSigma * normal_(random_);
    SetPose(state, pose);
  }

  const std::vector<PlanarPose>& guide_;
  double tube_m_;
  double uniform_share_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_;
  std::normal_distribution<double> normal_;
  std::size_t drawn_ = 0;
};

/// OMPL seeds its generators one after the other, in the order in which the process makes them.
class SeededSimplifier : public og::PathSimplifier {
 public:
  SeededSimplifier(const ob::SpaceInformationPtr& info, const ob::OptimizationObjectivePtr& cost,
                   int seed)
      : og::PathSimplifier(info, nullptr, cost) {
    rng_.setLocalSeed(static_cast<std::uint_fast32_t>(seed));
  }
};

std::shared_ptr<DriveSpace> MakeSpace(const FreeSpace& free_space,
                                      const std::vector<PlanarPose>& guide,
                                      const GlobalPlannerConfig& config) {
  auto space = std::make_shared<DriveSpace>(config.turn_cost_m);
  ob::RealVectorBounds bounds(2);
  const OccupancyGrid& grid = free_space.grid().grid();
  for (unsigned i = 0; i < 2; ++i) {
    bounds.low[i] = grid.origin[i];
    bounds.high[i] = grid.origin[i] + grid.resolution_m * (i == 0 ? grid.width : grid.height);
  }
  space->setBounds(bounds);
  space->setStateSamplerAllocator([&guide, &config](const ob::StateSpace* of) {
    return std::make_shared<TubeSampler>(of, guide, config);
  });
  return space;
}

ob::SpaceInformationPtr MakeInformation(const FreeSpace& free_space,
                                        const ob::StateSpacePtr& space) {
  auto info = std::make_shared<ob::SpaceInformation>(space);
  info->setStateValidityChecker([info = info.get(), &free_space](const ob::State* state) {
    return info->satisfiesBounds(state) && free_space.IsFree(PoseOf(state));
  });
  info->setMotionValidator(std::make_shared<DriveValidator>(info, free_space));
  info->setup();
  return info;
}

ob::ProblemDefinitionPtr MakeProblem(const ob::SpaceInformationPtr& info,
                                     const ob::OptimizationObjectivePtr& cost,
                                     const std::vector<PlanarPose>& guide) {
  auto problem = std::make_shared<ob::ProblemDefinition>(info);
  ob::ScopedState<ob::SE2StateSpace> start(info->getStateSpace());
  ob::ScopedState<ob::SE2StateSpace> goal(info->getStateSpace());
  SetPose(start.get(), guide.front());
  SetPose(goal.get(), guide.back());
  constexpr double kSame = 1e-6;
  problem->setStartAndGoalStates(start, goal, kSame);
  problem->setOptimizationObjective(cost);
  return problem;
}

bool Solve(const ob::SpaceInformationPtr& info, const ob::ProblemDefinitionPtr& problem,
           const GlobalPlannerConfig& config, std::size_t samples) {
  og::RRTstar planner(info);
  planner.setProblemDefinition(problem);
  planner.setRange(config.range_m);
  planner.setGoalBias(0.0);
  // The other structures draw random numbers of their own.
  planner.setNearestNeighbors<ompl::NearestNeighborsLinear>();
  planner.setup();
  ob::IterationTerminationCondition enough(static_cast<unsigned>(samples));
  return planner.solve(enough) == ob::PlannerStatus::EXACT_SOLUTION;
}

PoseChain ChainOf(og::PathGeometric& path, const ob::OptimizationObjectivePtr& cost) {
  PoseChain chain;
  for (const ob::State* state : path.getStates()) chain.poses.push_back(PoseOf(state));
  chain.cost = path.cost(cost).value();
  return chain;
}

}  // namespace

PoseChain SearchTree(const FreeSpace& free_space, const std::vector<PlanarPose>& guide,
                     const GlobalPlannerConfig& config) {
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  const auto space = MakeSpace(free_space, guide, config);
  const ob::SpaceInformationPtr info = MakeInformation(free_space, space);
  const auto cost = std::make_shared<DriveObjective>(info, free_space, config.turn_cost_m);
  const ob::ProblemDefinitionPtr problem = MakeProblem(info, cost, guide);
  const std::size_t samples = guide.size() + static_cast<std::size_t>(config.samples);
  if (!Solve(info, problem, config, samples)) return {};
  auto& path = *problem->getSolutionPath()->as<og::PathGeometric>();
  SeededSimplifier simplifier(info, cost, config.seed);
  simplifier.shortcutPath(path);
  return ChainOf(path, cost);
}

}  // namespace hv::navigation
