#include "hv_replay/drive_journal.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <vector>

namespace hv::replay {
namespace {

constexpr char kCycleHeader[] =
    "stamp,trial,state,x,y,yaw,true_x,true_y,true_yaw,linear_mps,angular_rps,command_linear,"
    "command_angular,remaining_m,localized,plan_ms,control_ms,grids_ms,update_ms,depth_ms,"
    "octree_nodes,walkers,reason";

double Sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

void Append(const std::vector<double>& from, std::vector<double>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

void NoteTimes(const DriveCycle& cycle, NavigationTrial& trial) {
  Append(cycle.update_ms, trial.update_ms);
  Append(cycle.depth_ms, trial.depth_ms);
  trial.control_ms.push_back(cycle.control_ms);
  trial.grids_ms.push_back(cycle.grids_ms);
  if (cycle.output.planning_ms) trial.plan_ms.push_back(*cycle.output.planning_ms);
  trial.octree_nodes = std::max(trial.octree_nodes, cycle.octree_nodes);
}

void NotePlace(const DriveCycle& cycle, const navigation::PlanarPose& truth,
               NavigationTrial& trial) {
  trial.driven_m += (truth.position - trial.line.back()).norm();
  trial.line.push_back(truth.position);
  if (!cycle.place) return;
  const Pose T_map_base = cycle.place->T_map_odom * cycle.place->T_odom_base;
  const Eigen::Vector2d believed = T_map_base.translation().head<2>();
  trial.worst_place_m = std::max(trial.worst_place_m, (believed - truth.position).norm());
}

}  // namespace

DriveJournal::DriveJournal(const std::string& folder)
    : collision_log_(folder + "/collisions.csv"),
      cycle_log_(folder + "/cycles.csv", kCycleHeader) {}

void DriveJournal::Note(const DriveCycle& cycle, const Pose& T_map_world, NavigationTrial& trial) {
  const navigation::PlanarPose truth = navigation::Planar(T_map_world * cycle.T_world_base);
  NoteTimes(cycle, trial);
  NotePlace(cycle, truth, trial);
  CollisionCount count;
  collision_log_.Note(cycle, T_map_world, trial.number, count);
  trial.collisions += count.collisions;
  trial.hit_by_people += count.hit_by_people;
  trial.contacts.insert(trial.contacts.end(), count.contacts.begin(), count.contacts.end());
  Log(cycle, truth, trial.number);
}

void DriveJournal::Log(const DriveCycle& cycle, const navigation::PlanarPose& truth, int trial) {
  navigation::PlanarPose place;
  navigation::Velocity velocity;
  if (cycle.place) {
    place = navigation::Planar(cycle.place->T_map_odom * cycle.place->T_odom_base);
    velocity = cycle.place->velocity;
  }
  const navigation::NavigationOutput& output = cycle.output;
  char text[512];
  std::snprintf(text, sizeof(text),
                ",%d,%s,%.3f,%.3f,%.4f,%.3f,%.3f,%.4f,%.3f,%.3f,%.3f,%.3f,%.2f,%d,%.2f,%.2f,%.2f,"
                "%.2f,%.2f,%zu,%zu,",
                trial, navigation::ToString(output.state), place.position.x(), place.position.y(),
                place.yaw, truth.position.x(), truth.position.y(), truth.yaw, velocity.linear_mps,
                velocity.angular_rps, output.velocity.linear_mps, output.velocity.angular_rps,
                output.remaining_m, cycle.place && cycle.place->localized ? 1 : 0,
                output.planning_ms.value_or(0.0), cycle.control_ms, cycle.grids_ms,
                Sum(cycle.update_ms), Sum(cycle.depth_ms), cycle.octree_nodes, cycle.walkers);
  cycle_log_.Append(ToString(cycle.stamp) + text + '"' + output.reason + '"');
}

}  // namespace hv::replay
