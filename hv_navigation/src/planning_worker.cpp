#include "hv_navigation/planning_worker.h"

#include <chrono>
#include <utility>
#include <vector>

namespace hv::navigation {

std::shared_ptr<const ClearanceGrid> WithObstaclesOf(const PlanningJob& job) {
  std::vector<Eigen::Vector2i> cells;
  for (const Eigen::Vector2d& place : job.seen.MissingIn(*job.map)) {
    cells.push_back(job.map->CellOf(place));
  }
  for (const Eigen::Vector2d& place : job.remembered) {
    const Eigen::Vector2i cell = job.map->CellOf(place);
    if (job.map->Contains(cell)) cells.push_back(cell);
  }
  if (cells.empty()) return job.map;
  return std::make_shared<const ClearanceGrid>(job.map->WithObstacles(cells));
}

PlanningWorker::PlanningWorker(const GlobalPlanner& planner, Mode mode)
    : planner_(planner), mode_(mode) {
  if (mode_ == Mode::kInBackground) thread_ = std::thread([this] { Loop(); });
}

PlanningWorker::~PlanningWorker() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

FinishedPlan PlanningWorker::Run(const PlanningJob& job) const {
  const auto begin = std::chrono::steady_clock::now();
  const auto grid = WithObstaclesOf(job);
  FinishedPlan finished{job.goal_id, planner_.Plan(*grid, job.request), grid != job.map, 0.0};
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
  finished.planning_ms = taken.count();
  return finished;
}

void PlanningWorker::Request(PlanningJob job) {
  if (mode_ == Mode::kAtOnce) {
    FinishedPlan finished = Run(job);
    const std::lock_guard<std::mutex> lock(mutex_);
    finished_ = std::move(finished);
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_ = std::move(job);
  }
  changed_.notify_all();
}

bool PlanningWorker::Busy() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return running_ || waiting_.has_value();
}

std::optional<FinishedPlan> PlanningWorker::Take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(finished_, std::nullopt);
}

void PlanningWorker::Loop() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || waiting_.has_value(); });
    if (stop_) return;
    const PlanningJob job = *std::exchange(waiting_, std::nullopt);
    running_ = true;
    lock.unlock();
    FinishedPlan finished = Run(job);
    lock.lock();
    finished_ = std::move(finished);
    running_ = false;
  }
}

}  // namespace hv::navigation
