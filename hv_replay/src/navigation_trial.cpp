#include "hv_replay/navigation_trial.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "hv_replay/trajectory_error.h"
#include "quantile.h"

namespace hv::replay {
namespace {

using Times = std::vector<double> NavigationTrial::*;

constexpr double kPeriod_ms = 100.0;

double Largest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

std::size_t Late(const std::vector<double>& milliseconds) {
  return static_cast<std::size_t>(std::count_if(milliseconds.begin(), milliseconds.end(),
                                                [](double ms) { return ms > kPeriod_ms; }));
}

std::vector<double> All(const std::vector<NavigationTrial>& trials, Times times) {
  std::vector<double> all;
  for (const NavigationTrial& trial : trials) {
    all.insert(all.end(), (trial.*times).begin(), (trial.*times).end());
  }
  return all;
}

std::string Quoted(std::string text) {
  std::replace(text.begin(), text.end(), '"', '\'');
  return '"' + text + '"';
}

}  // namespace

JsonObject TimesJson(const std::vector<double>& milliseconds) {
  JsonObject json;
  json.AddCount("count", milliseconds.size())
      .Add("median", Quantile(milliseconds, 0.5))
      .Add("p95", Quantile(milliseconds, 0.95))
      .Add("max", Largest(milliseconds))
      .AddCount("above_100_ms", Late(milliseconds));
  return json;
}

std::string TrialHeader() {
  return "trial,start_x,start_y,start_yaw,goal_x,goal_y,goal_yaw,reached,end_distance_m,"
         "end_turn_deg,driven_m,optimal_m,time_s,collisions,hit_by_people,recoveries,plans,"
         "plan_median_ms,plan_max_ms,cycles,late_cycles,control_median_ms,control_max_ms,"
         "update_median_ms,update_max_ms,octree_nodes,worst_place_m,boxed,response_s,response,"
         "reason";
}

std::string TrialRow(const NavigationTrial& trial) {
  const double turn_deg = 180.0 / M_PI * navigation::WrappedAngle(trial.end.yaw - trial.goal.yaw);
  char text[640];
  std::snprintf(
      text, sizeof(text),
      "%d,%.3f,%.3f,%.4f,%.3f,%.3f,%.4f,%d,%.3f,%.2f,%.3f,%.3f,%.1f,%d,%d,%d,%zu,%.2f,%.2f,%zu,"
      "%zu,%.2f,%.2f,%.2f,%.2f,%zu,%.3f,%d,%.2f,",
      trial.number, trial.start.position.x(), trial.start.position.y(), trial.start.yaw,
      trial.goal.position.x(), trial.goal.position.y(), trial.goal.yaw, trial.reached ? 1 : 0,
      trial.EndDistance(), turn_deg, trial.driven_m, trial.optimal_m, trial.time_s,
      trial.collisions, trial.hit_by_people, trial.recoveries, trial.plan_ms.size(),
      Quantile(trial.plan_ms, 0.5), Largest(trial.plan_ms), trial.control_ms.size(),
      Late(trial.control_ms), Quantile(trial.control_ms, 0.5), Largest(trial.control_ms),
      Quantile(trial.update_ms, 0.5), Largest(trial.update_ms), trial.octree_nodes,
      trial.worst_place_m, trial.boxed ? 1 : 0, trial.response_s);
  return text + Quoted(trial.response) + "," + Quoted(trial.reason);
}

JsonObject SummaryJson(const std::vector<NavigationTrial>& trials) {
  std::size_t reached = 0;
  std::size_t boxed = 0;
  std::size_t nodes = 0;
  int collisions = 0;
  int hit_by_people = 0;
  int recoveries = 0;
  double time_s = 0.0;
  double driven_m = 0.0;
  double optimal_m = 0.0;
  std::vector<double> ratios;
  std::vector<double> responses;
  for (const NavigationTrial& trial : trials) {
    collisions += trial.collisions;
    hit_by_people += trial.hit_by_people;
    recoveries += trial.recoveries;
    time_s += trial.time_s;
    nodes = std::max(nodes, trial.octree_nodes);
    boxed += trial.boxed ? 1 : 0;
    if (trial.response_s >= 0.0) responses.push_back(trial.response_s);
    if (!trial.reached) continue;
    ++reached;
    driven_m += trial.driven_m;
    optimal_m += trial.optimal_m;
    ratios.push_back(trial.driven_m / trial.optimal_m);
  }
  JsonObject json;
  json.AddCount("goals", trials.size())
      .AddCount("reached", reached)
      .AddCount("collisions", collisions)
      .AddCount("hit_by_people", hit_by_people)
      .AddCount("recoveries", recoveries)
      .Add("time_s", time_s)
      .Add("driven_m", driven_m)
      .Add("optimal_m", optimal_m)
      .Add("driven_over_optimal", optimal_m > 0.0 ? driven_m / optimal_m : 0.0)
      .Add("worst_driven_over_optimal", Largest(ratios))
      .Add("plan_ms", TimesJson(All(trials, &NavigationTrial::plan_ms)))
      .Add("control_ms", TimesJson(All(trials, &NavigationTrial::control_ms)))
      .Add("update_ms", TimesJson(All(trials, &NavigationTrial::update_ms)))
      .Add("depth_ms", TimesJson(All(trials, &NavigationTrial::depth_ms)))
      .Add("grids_ms", TimesJson(All(trials, &NavigationTrial::grids_ms)))
      .AddCount("octree_nodes", nodes)
      .AddCount("boxed", boxed)
      .Add("slowest_response_s", responses.empty() ? -1.0 : Largest(responses));
  return json;
}

}  // namespace hv::replay
