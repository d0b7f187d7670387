#include "hv_replay/exploration_drive.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "hv_explore_sac/policy/planner_maker.h"
#include "hv_replay/console.h"
#include "hv_replay/drive_picture.h"
#include "hv_replay/drive_start.h"
#include "hv_replay/navigation_trial.h"
#include "hv_replay/result_files.h"

namespace hv::replay {
namespace {

constexpr double kCoveragePeriod_s = 1.0;
constexpr double kPathPeriod_s = 0.5;

std::unique_ptr<RobotLocator> MakeLocator(const SlamConfig& config, const sim::SensorRig& rig,
                                          bool by_truth) {
  return by_truth ? LocateByTruth(Pose::Identity(), rig) : LocateBySensors(config, "", rig);
}

explore::RobotSize SizeOf(const navigation::Footprint& footprint) {
  return {footprint.InscribedRadius(), footprint.CircumscribedRadius()};
}

/// With what is kept free around the robot.
sim::RobotShape Grown(sim::RobotShape shape, double margin_m) {
  shape.front_m += margin_m;
  shape.back_m += margin_m;
  shape.half_width_m += margin_m;
  return shape;
}

std::optional<explore::GoalOutcome> OutcomeOf(const navigation::NavigationOutput& output) {
  if (!output.result || *output.result == navigation::NavigationResult::kCancelled) {
    return std::nullopt;
  }
  const bool reached = *output.result == navigation::NavigationResult::kReached;
  return explore::GoalOutcome{reached,
                              std::string(ToString(*output.result)) + ": " + output.reason};
}

JsonObject PointJson(const CoveragePoint* point) {
  JsonObject json;
  if (point == nullptr) return json;
  json.Add("time_s", point->time_s).Add("travelled_m", point->travelled_m);
  return json;
}

}  // namespace

const CoveragePoint* ExplorationDriveResult::WhenKnown(double share) const {
  const auto found = std::find_if(coverage.begin(), coverage.end(),
                                  [share](const auto& point) { return point.share >= share; });
  return found == coverage.end() ? nullptr : &*found;
}

JsonObject SummaryJson(const ExplorationDriveResult& result) {
  const explore::ExplorationResult& exploration = result.exploration;
  const CoveragePoint last = result.coverage.empty() ? CoveragePoint() : result.coverage.back();
  JsonObject json;
  json.Add("success", exploration.success)
      .Add("reason", exploration.reason)
      .Add("time_s", last.time_s)
      .Add("travelled_m", last.travelled_m)
      .Add("explored_m2", last.explored_m2)
      .Add("reachable_m2", result.reachable_m2)
      .Add("share", last.share)
      .AddCount("collisions", result.collisions.collisions)
      .AddCount("hit_by_people", result.collisions.hit_by_people)
      .AddCount("goals", exploration.progress.goals)
      .AddCount("failed_goals", exploration.progress.failed_goals)
      .AddCount("loops", exploration.progress.loops)
      .Add("known_50", PointJson(result.WhenKnown(0.5)))
      .Add("known_80", PointJson(result.WhenKnown(0.8)))
      .Add("known_90", PointJson(result.WhenKnown(0.9)))
      .Add("known_95", PointJson(result.WhenKnown(0.95)))
      .Add("decision_ms", TimesJson(result.decision_ms));
  return json;
}

ExplorationDrive::ExplorationDrive(const SlamConfig& config, sim::World world,
                                   const sim::LiveConfig& simulation,
                                   const ExplorationDriveOptions& options)
    : config_(config),
      options_(options),
      shape_(Grown(simulation.robot.shape, config.exploration.explorer.places.margin_m)),
      world_(world),
      explorer_(config.exploration.explorer, SizeOf(config.navigation.planning.footprint),
                explore::PlannerMakerOf(
                    config.exploration.explorer.choice.planner,
                    config.exploration.explorer.choice.weights,
                    explore::MakeOnlineLearner(config.exploration.explorer.online_learning,
                                               config.exploration.explorer.choice.weights))),
      coverage_log_(CreateDirectory(options.out) + "/coverage.csv",
                    "time_s,travelled_m,explored_m2,share,frontiers,goals,x,y"),
      goal_log_(options.out + "/goals.csv", "time_s,x,y,yaw,utility"),
      collision_log_(options.out + "/collisions.csv") {
  drive_ = std::make_unique<SimulatedDrive>(
      std::move(world), simulation, config_,
      MakeLocator(config_, sim::MakeRig(simulation.suite), options_.truth_pose), std::nullopt);
}

ExplorationDriveResult ExplorationDrive::Run() {
  WriteText(options_.out + "/config.yaml", ToYaml(config_));
  ExplorationDriveResult result;
  last_ = WaitForPlace(*drive_);
  T_map_world_ = WorldInMap(last_);
  ground_ = std::make_unique<ReachableGround>(world_, shape_, last_.T_world_base);
  result.reachable_m2 = ground_->area_m2();
  began_s_ = drive_->time_s();
  Note(result);
  explorer_.Start({{}, options_.time_limit_s, options_.return_home});
  ProgressLine progress(world_.name);
  while (true) {
    const explore::ExplorerOutput output = Explore(result);
    if (output.result) {
      result.exploration = *output.result;
      break;
    }
    last_ = drive_->Cycle();
    Note(result);
    const CoveragePoint& now = result.coverage.back();
    progress.Update(now.share, std::to_string(static_cast<int>(now.travelled_m)) + " m");
  }
  NoteCoverage(result);
  Write(result);
  return result;
}

explore::ExplorerOutput ExplorationDrive::Explore(ExplorationDriveResult& result) {
  const int decisions = explorer_.progress().decisions;
  const auto begin = std::chrono::steady_clock::now();
  const explore::ExplorerOutput output = explorer_.Update(InputNow());
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
  if (explorer_.progress().decisions > decisions) result.decision_ms.push_back(taken.count());
  if (output.stop) drive_->Cancel();
  if (output.goal) {
    drive_->SetGoal(*output.goal);
    NoteGoal(output);
  }
  return output;
}

explore::ExplorerInput ExplorationDrive::InputNow() const {
  explore::ExplorerInput input;
  input.now = last_.stamp;
  if (const auto& map = drive_->view().map) input.map = {map, &map->grid()};
  if (last_.place && last_.place->localized) {
    input.T_map_base = navigation::Planar(last_.place->T_map_odom * last_.place->T_odom_base);
  }
  input.outcome = OutcomeOf(last_.output);
  return input;
}

void ExplorationDrive::Note(ExplorationDriveResult& result) {
  const Pose T_map_base = T_map_world_ * last_.T_world_base;
  const Eigen::Vector2d position = T_map_base.translation().head<2>();
  if (!result.line.empty()) travelled_m_ += (position - result.line.back()).norm();
  result.line.push_back(position);
  collision_log_.Note(last_, T_map_world_, 1, result.collisions);
  if (path_.empty() || last_.stamp - path_.back().stamp >= kPathPeriod_s) {
    path_.push_back({last_.stamp, T_map_base});
  }
  const double time_s = drive_->time_s() - began_s_;
  if (result.coverage.empty() || time_s >= result.coverage.back().time_s + kCoveragePeriod_s) {
    NoteCoverage(result);
  }
}

void ExplorationDrive::NoteCoverage(ExplorationDriveResult& result) {
  const OccupancyGrid& map = drive_->view().map->grid();
  CoveragePoint point;
  point.time_s = drive_->time_s() - began_s_;
  point.travelled_m = travelled_m_;
  point.explored_m2 = explore::FreeArea(map, {});
  point.share = ground_->ShareKnown(map, T_map_world_);
  result.coverage.push_back(point);
  const explore::ExplorationProgress& progress = explorer_.progress();
  char text[160];
  std::snprintf(text, sizeof(text), "%.1f,%.2f,%.2f,%.4f,%d,%d,%.3f,%.3f", point.time_s,
                point.travelled_m, point.explored_m2, point.share, progress.frontiers,
                progress.goals, result.line.back().x(), result.line.back().y());
  coverage_log_.Append(text);
}

void ExplorationDrive::NoteGoal(const explore::ExplorerOutput& output) {
  const navigation::PlanarPose& goal = *output.goal;
  char text[128];
  std::snprintf(text, sizeof(text), "%.1f,%.3f,%.3f,%.4f,%d", drive_->time_s() - began_s_,
                goal.position.x(), goal.position.y(), goal.yaw,
                explorer_.goal() ? explorer_.goal()->utility : 0);
  goal_log_.Append(text);
}

void ExplorationDrive::Write(const ExplorationDriveResult& result) const {
  WriteTum(options_.out + "/path.tum", Trajectory(path_));
  WriteText(options_.out + "/summary.json", SummaryJson(result).ToString() + "\n");
  char title[160];
  std::snprintf(title, sizeof(title), "%s: %.1f %% known after %.0f m and %.0f s",
                world_.name.c_str(), 100.0 * result.coverage.back().share,
                result.coverage.back().travelled_m, result.coverage.back().time_s);
  DrawExploration(drive_->view().map->grid(), {result.line, result.collisions.contacts}, title,
                  options_.out + "/exploration.png");
}

}  // namespace hv::replay
