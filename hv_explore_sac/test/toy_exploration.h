#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "toy_building.h"

namespace hv::explore {

/// A robot, its navigation and the explorer that sends it around.
class Exploration {
 public:
  explicit Exploration(const ExplorerConfig& config = {},
                       GoalChooser::PlannerMaker make_planner = nullptr,
                       const Eigen::Vector2d& start = {6.05, 1.25})
      : robot(TwoRooms(), start), explorer(config, kRobotSize, std::move(make_planner)) {}

  /// Half a second; navigation fails where `refuses` says so.
  ExplorerOutput Step() {
    ExplorerInput input;
    input.now = Time::FromSeconds(time_s += 0.5);
    if (has_map) input.map = robot.SharedMap();
    if (has_place) input.T_map_base = robot.pose();
    input.outcome = Navigate();
    const ExplorerOutput output = explorer.Update(input);
    if (output.stop) goal.reset();
    if (output.goal) {
      goal = output.goal;
      goals.push_back(*output.goal);
    }
    return output;
  }

  /// To the end of the task.
  ExplorationResult Run(int most_steps = 2000) {
    for (int i = 0; i < most_steps; ++i) {
      const ExplorerOutput output = Step();
      if (output.result) return *output.result;
    }
    ADD_FAILURE() << "the exploration does not end";
    return {};
  }

  ToyRobot robot;
  Explorer explorer;
  double time_s = 100.0;
  bool has_map = true;
  bool has_place = true;
  bool drives = true;
  std::function<bool(const Eigen::Vector2d&)> refuses = [](const auto&) { return false; };
  std::optional<navigation::PlanarPose> goal;
  std::vector<navigation::PlanarPose> goals;

 private:
  std::optional<GoalOutcome> Navigate() {
    if (!goal || !drives) return std::nullopt;
    if (refuses(goal->position)) {
      goal.reset();
      return GoalOutcome{false, "no path"};
    }
    if (!robot.DriveTowards(goal->position, 0.4)) return std::nullopt;
    goal.reset();
    return GoalOutcome{true, ""};
  }
};

}  // namespace hv::explore
