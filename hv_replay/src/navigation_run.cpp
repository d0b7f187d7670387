#include "hv_replay/navigation_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hv_core/error.h"
#include "hv_core/map_folder.h"
#include "hv_replay/console.h"
#include "hv_replay/drive_picture.h"
#include "hv_replay/drive_start.h"
#include "hv_replay/mapped_start.h"
#include "hv_replay/result_files.h"
#include "hv_replay/trajectory_error.h"

namespace hv::replay {
namespace {

constexpr double kArrived_m = 0.5;
constexpr int kTriesPerBox = 3;

/// No drive takes longer, whatever the navigator says.
double LongestDrive_s(double optimal_m) { return 180.0 + 6.0 * optimal_m; }

Pose TruthInMap(const NavigationRunOptions& options) {
  if (options.map.empty()) return Pose::Identity();
  if (options.map_truth.empty()) {
    throw InputError("a map needs the truth of the run that made it (--map-truth)");
  }
  return CompareTrajectories(MapFolder::Open(options.map).ReadPoses(), ReadTum(options.map_truth),
                             {})
      .T_reference_estimate;
}

std::optional<OccupancyGrid> SavedGrid(const std::string& map) {
  if (map.empty()) return std::nullopt;
  return MapFolder::Open(map).ReadGrid();
}

/// With a map, the robot starts where that was made.
sim::LiveConfig Started(const sim::LiveConfig& simulation, const sim::World& world,
                        const NavigationRunOptions& options, const Pose& T_map_world) {
  if (options.map.empty()) return simulation;
  return WithMappedStart(simulation, world, MapFolder::Open(options.map).ReadPoses(), T_map_world);
}

/// The robot is told about where it is, since places of many buildings are alike.
std::unique_ptr<RobotLocator> MakeLocator(const SlamConfig& config,
                                          const NavigationRunOptions& options,
                                          const sim::LiveConfig& simulation,
                                          const Pose& T_map_world) {
  const sim::SensorRig rig = sim::MakeRig(simulation.suite);
  if (options.truth_pose) return LocateByTruth(T_map_world, rig);
  if (options.map.empty()) return LocateBySensors(config, "", rig);
  const std::vector<double>& start = simulation.start;
  const Eigen::Vector3d error(0.4, -0.3, 0.0);
  constexpr double kTurned_deg = 8.0;
  const Pose told = MakePose(RotationFromRpy(0.0, 0.0, (start[3] + kTurned_deg) * M_PI / 180.0),
                             Eigen::Vector3d(start[0], start[1], start[2]) + error);
  return LocateBySensors(config, options.map, rig, T_map_world * told);
}

}  // namespace

NavigationRun::NavigationRun(const SlamConfig& config, sim::World world,
                             const sim::LiveConfig& simulation, const NavigationRunOptions& options)
    : config_(config),
      options_(options),
      title_(world.name),
      T_map_world_(TruthInMap(options)),
      saved_(SavedGrid(options.map)),
      floor_radius_m_(config.navigation.planning.footprint.half_width_m),
      seed_(static_cast<std::uint32_t>(simulation.seed)) {
  CreateDirectory(options_.out);
  const sim::LiveConfig started = Started(simulation, world, options_, T_map_world_);
  drive_ = std::make_unique<SimulatedDrive>(std::move(world), started, config_,
                                            MakeLocator(config_, options_, started, T_map_world_),
                                            saved_);
  trial_log_ = std::make_unique<CsvLog>(options_.out + "/trials.csv", TrialHeader());
  journal_ = std::make_unique<DriveJournal>(options_.out);
}

std::vector<NavigationTrial> NavigationRun::Run() {
  WriteText(options_.out + "/config.yaml", ToYaml(config_));
  FindPlace();
  std::vector<NavigationTrial> trials;
  ProgressLine progress(title_);
  const bool boxes = options_.scenario != NavigationScenario::kRandom;
  const int most = boxes ? kTriesPerBox * options_.goals : options_.goals;
  for (int tried = 0; tried < most && static_cast<int>(trials.size()) < options_.goals; ++tried) {
    const std::optional<GoalSampler::Goal> goal = NextGoal();
    if (!goal) break;
    NavigationTrial trial = Drive(*goal, static_cast<int>(trials.size()) + 1);
    WaitForBoxToGo();
    if (boxes && !trial.boxed) continue;
    trial_log_->Append(TrialRow(trial));
    trials.push_back(std::move(trial));
    const auto reached = std::count_if(trials.begin(), trials.end(),
                                       [](const NavigationTrial& one) { return one.reached; });
    progress.Update(static_cast<double>(trials.size()) / options_.goals,
                    std::to_string(reached) + " of " + std::to_string(trials.size()) + " reached");
  }
  WriteText(options_.out + "/summary.json", SummaryJson(trials).ToString() + "\n");
  Draw(trials);
  return trials;
}

void NavigationRun::FindPlace() {
  last_ = WaitForPlace(*drive_);
  if (options_.map.empty()) T_map_world_ = WorldInMap(last_);
}

/// Without a saved map, goals lie in what has been seen by now.
std::optional<GoalSampler::Goal> NavigationRun::NextGoal() {
  const navigation::Footprint& footprint = config_.navigation.planning.footprint;
  if (!goals_ || !saved_) {
    const OccupancyGrid& known = saved_ ? *saved_ : drive_->view().map->grid();
    goals_.emplace(known, footprint,
                   seed_ + (saved_ ? 0U : static_cast<std::uint32_t>(last_.stamp.nanoseconds())));
  }
  return goals_->Next(InMap(last_.T_world_base), options_.least_m);
}

NavigationTrial NavigationRun::Drive(const GoalSampler::Goal& goal, int number) {
  NavigationTrial trial;
  trial.number = number;
  trial.start = InMap(last_.T_world_base);
  trial.goal = goal.pose;
  trial.optimal_m = goal.optimal_m;
  trial.line.push_back(trial.start.position);
  box_.reset();
  drive_->SetGoal(goal.pose);
  const double begin_s = drive_->time_s();
  const double longest_s = LongestDrive_s(goal.optimal_m);
  bool given_up = false;
  do {
    const int recoveries = last_.output.recoveries;
    last_ = drive_->Cycle();
    trial.recoveries += std::max(0, last_.output.recoveries - recoveries);
    journal_->Note(last_, T_map_world_, trial);
    PutBox(last_, trial);
    NoteResponse(last_, trial);
    trial.time_s = drive_->time_s() - begin_s;
    if (trial.time_s > longest_s && !given_up) {
      drive_->Cancel();
      given_up = true;
    }
  } while (!last_.output.result);
  trial.end = InMap(last_.T_world_base);
  const bool reached = *last_.output.result == navigation::NavigationResult::kReached;
  trial.reached = reached && trial.EndDistance() < kArrived_m;
  if (!reached) trial.reason = std::string(ToString(*last_.output.result));
  if (reached && !trial.reached) trial.reason = "is elsewhere than it takes itself to be";
  if (given_up) trial.reason = "too long under way";
  if (!last_.output.reason.empty()) trial.reason += ": " + last_.output.reason;
  return trial;
}

DriveSituation NavigationRun::SituationAt(const DriveCycle& cycle) const {
  static const navigation::Path kNone;
  return {goals_->map(),
          T_map_world_,
          cycle.T_world_base,
          cycle.place ? cycle.place->velocity : navigation::Velocity(),
          cycle.output.plan ? *cycle.output.plan : kNone,
          cycle.output.remaining_m,
          drive_->time_s()};
}

void NavigationRun::PutBox(const DriveCycle& cycle, NavigationTrial& trial) {
  if (trial.boxed || cycle.output.state != navigation::NavigationState::kDriving) return;
  box_ = BoxAhead(options_.scenario, SituationAt(cycle));
  if (!box_) return;
  drive_->Add(*box_);
  trial.boxed = true;
}

/// From the moment at which the box is there to a plan that leads past it, or a word of why not.
void NavigationRun::NoteResponse(const DriveCycle& cycle, NavigationTrial& trial) {
  if (!box_ || trial.response_s >= 0.0) return;
  const double since_s = drive_->time_s() - box_->from_s;
  if (since_s <= 0.0) return;
  const navigation::NavigationOutput& output = cycle.output;
  const bool past =
      output.plan && LeadsPast(*output.plan, SituationAt(cycle), *box_, floor_radius_m_);
  const bool told = output.result || !output.reason.empty();
  if (!past && !told) return;
  trial.response_s = since_s;
  trial.response = past ? "new plan" : output.reason;
}

void NavigationRun::WaitForBoxToGo() {
  if (!box_ || !std::isfinite(box_->until_s)) return;
  while (drive_->time_s() <= box_->until_s + SimulatedDrive::kPeriod_s) last_ = drive_->Cycle();
  drive_->ForgetViews();
  last_ = drive_->Cycle();
}

void NavigationRun::Draw(const std::vector<NavigationTrial>& trials) const {
  if (!drive_->view().map) return;
  std::vector<DrivenLine> lines;
  std::size_t reached = 0;
  for (const NavigationTrial& trial : trials) {
    lines.push_back({trial.line, trial.goal.position, !trial.reached, trial.contacts});
    reached += trial.reached ? 1 : 0;
  }
  const std::string title = title_ + ": " + std::to_string(reached) + " of " +
                            std::to_string(trials.size()) + " goals reached";
  DrawDrives(saved_ ? *saved_ : drive_->view().map->grid(), lines, title,
             options_.out + "/drives.png");
}

navigation::PlanarPose NavigationRun::InMap(const Pose& T_world_base) const {
  return navigation::Planar(T_map_world_ * T_world_base);
}

}  // namespace hv::replay
