#include "hv_explore_sac/exploration_run.h"

#include <ctime>

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

namespace hv::explore {
namespace {

/// Processor time of this thread, which other programs do not lengthen [ms].
double ThreadTimeMs() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Means of how long something takes [ms].
class Stopwatch {
 public:
  template <typename Work>
  void Time(Work work) {
    const double begin_ms = ThreadTimeMs();
    work();
    total_ms_ += ThreadTimeMs() - begin_ms;
    ++count_;
  }
  double Mean() const { return count_ == 0 ? 0.0 : total_ms_ / count_; }

 private:
  double total_ms_ = 0.0;
  int count_ = 0;
};

}  // namespace

RunResult RunExploration(const ExplorationMap& map, const std::string& planner,
                         const RaySensor& sensor, const EvaluationConfig& config) {
  DungeonEnvironment environment(config.exploration, RewardConfig(), sensor, map);
  const std::unique_ptr<Planner> chooser =
      config.make_planner(planner, {config.planner, config.exploration, &sensor, &map});
  LoopGuard guard(config.guard);
  Observation observation;
  Stopwatch deciding;
  Stopwatch stepping;
  while (environment.ending() == Ending::kRunning) {
    Decision decision;
    deciding.Time([&] {
      environment.Observe(observation);
      decision = guard.Review(chooser->Choose(observation, environment.model()), observation,
                              environment.model());
    });
    stepping.Time([&] { environment.Step(observation.node(decision.action).viewpoint); });
  }
  RunResult result;
  result.map = map.name;
  result.planner = planner;
  result.unit = map.unit;
  result.travel = environment.travel() * map.cell_size;
  result.explored = environment.explored();
  result.steps = environment.steps();
  result.ending = environment.ending();
  result.done = environment.complete();
  result.interventions = guard.interventions();
  result.decision_ms = deciding.Mean();
  result.step_ms = stepping.Mean();
  result.path = environment.path();
  return result;
}

std::vector<RunResult> Evaluate(const std::vector<ExplorationMap>& maps,
                                const std::vector<std::string>& planners,
                                const EvaluationConfig& config,
                                const std::function<void(std::size_t, std::size_t)>& progress) {
  const RaySensor sensor(config.exploration.simulation);
  std::vector<RunResult> results(maps.size() * planners.size());
  std::atomic<std::size_t> next{0};
  std::size_t finished = 0;
  std::exception_ptr error;
  std::mutex mutex;  // of `finished`, `error` and the callback
  const auto work = [&] {
    for (std::size_t i = next++; i < results.size(); i = next++) {
      try {
        results[i] = RunExploration(maps[i / planners.size()], planners[i % planners.size()],
                                    sensor, config);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        error = std::current_exception();
        next = results.size();
      }
      const std::lock_guard<std::mutex> lock(mutex);
      progress(++finished, results.size());
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < config.threads; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (error) std::rethrow_exception(error);
  return results;
}

}  // namespace hv::explore
