#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "hv_navigation/global_planner.h"
#include "hv_navigation/obstacle_memory.h"

namespace hv::navigation {

/// All that a plan depends on.
struct PlanningJob {
  int goal_id = 0;  ///< comes back with the plan
  PlanRequest request;
  std::shared_ptr<const ClearanceGrid> map;
  SeenObstacles seen;
  std::vector<Eigen::Vector2d> remembered;  ///< places in the map where obstacles were
};

struct FinishedPlan {
  int goal_id = 0;
  GlobalPlan plan;
  bool with_obstacles = false;  ///< obstacles seen that the map lacks were minded
  double planning_ms = 0.0;     ///< with the time to mind them
};

/// The map with the obstacles seen and remembered. The same pointer when these add nothing.
std::shared_ptr<const ClearanceGrid> WithObstaclesOf(const PlanningJob& job);

/// Runs a planner, in a thread of its own or at once. One job runs at a time and one may wait; a
/// newer one takes the place of the waiting one, and a newer result that of an older one not taken.
/// Thread-safe.
class PlanningWorker {
 public:
  enum class Mode {
    kInBackground,
    kAtOnce,  ///< within Request(): deterministic
  };

  PlanningWorker(const GlobalPlanner& planner, Mode mode);
  /// Waits for the job that runs.
  ~PlanningWorker();
  PlanningWorker(const PlanningWorker&) = delete;
  PlanningWorker& operator=(const PlanningWorker&) = delete;

  void Request(PlanningJob job);
  /// Whether a job runs or waits.
  bool Busy() const;
  /// The newest result, once.
  std::optional<FinishedPlan> Take();

 private:
  FinishedPlan Run(const PlanningJob& job) const;
  void Loop();

  GlobalPlanner planner_;
  Mode mode_;
  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::optional<PlanningJob> waiting_;
  std::optional<FinishedPlan> finished_;
  bool running_ = false;
  bool stop_ = false;
  std::thread thread_;  // last: uses all of the above
};

}  // namespace hv::navigation
