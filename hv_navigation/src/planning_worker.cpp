#include "hv_navigation/planning_worker.h"

#include <chrono>
#include <utility>
#include <vector>

namespace hv::navigation {

namespace {

bool IsSeenFree(const SeenObstacles& seen, const Eigen::Vector2d& place) {
  const Eigen::Vector2i cell = seen.grid->CellOf(seen.T_map_grid.Inverse() * place);
  if (!seen.grid->Contains(cell)) return false;
  const std::int8_t value = seen.grid->grid().At(cell.x(), cell.y());
  return value != OccupancyGrid::kUnknown && !OccupancyGrid::IsOccupied(value);
}

void AddObstacles(const ClearanceGrid& map, const SeenObstacles& seen, const SeenObstacles* newer,
                  std::vector<Eigen::Vector2i>& added) {
  const OccupancyGrid& cells = seen.grid->grid();
  const double known_m = 1.5 * map.grid().resolution_m;
  for (int row = 0; row < cells.height; ++row) {
    for (int column = 0; column < cells.width; ++column) {
      if (!OccupancyGrid::IsOccupied(cells.At(column, row))) continue;
      const Eigen::Vector2d place = seen.T_map_grid * seen.grid->CenterOf({column, row});
      const Eigen::Vector2i cell = map.CellOf(place);
      if (!map.Contains(cell) || map.ClearanceAt(cell) <= known_m) continue;
      if (newer == nullptr || !IsSeenFree(*newer, place)) added.push_back(cell);
    }
  }
}

}  // namespace

std::shared_ptr<const ClearanceGrid> WithSeenObstacles(const PlanningJob& job) {
  std::vector<Eigen::Vector2i> added;
  for (const SeenObstacles& seen : job.seen) {
    const bool newest = &seen == &job.seen.front();
    AddObstacles(*job.map, seen, newest ? nullptr : &job.seen.front(), added);
  }
  if (added.empty()) return job.map;
  return std::make_shared<const ClearanceGrid>(job.map->WithObstacles(added));
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
  const auto grid = WithSeenObstacles(job);
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
