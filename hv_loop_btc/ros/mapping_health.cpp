#include "mapping_health.h"

#include <filesystem>
#include <utility>

#include "hv_core/memory.h"

namespace hv::loop {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr std::size_t kBehind = 10;  // waiting keyframes that are worth a warning

/// Size of all files below `folder` [MB].
double MegabytesIn(const std::string& folder) {
  namespace fs = std::filesystem;
  std::uintmax_t bytes = 0;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    const std::uintmax_t size = entry->is_regular_file(ignored) ? entry->file_size(ignored) : 0;
    if (!ignored) bytes += size;
  }
  return 1e-6 * static_cast<double>(bytes);
}

}  // namespace

MappingHealth::MappingHealth(const LoopEngine& engine, const KeyframeQueue& queue,
                             const MapSaving& saving, std::string work_folder)
    : engine_(engine), queue_(queue), saving_(saving), work_folder_(std::move(work_folder)) {}

void MappingHealth::SetProblem(const std::string& problem) {
  const std::lock_guard<std::mutex> lock(mutex_);
  problem_ = problem;
}

void MappingHealth::Summarize(const LoopState& state, const KeyframeQueue::Counters& queue,
                              Status& status) const {
  const std::size_t faults = state.unusable + queue.lost + queue.disk_errors;
  if (!problem_.empty()) {
    status.summary(DiagnosticStatus::WARN, problem_);
  } else if (faults > reported_faults_) {
    status.summary(DiagnosticStatus::WARN, state.last_error);
  } else if (queue.waiting > kBehind) {
    status.summaryf(DiagnosticStatus::WARN, "%zu keyframes behind", queue.waiting);
  } else if (!state.joined) {
    status.summary(DiagnosticStatus::WARN, "not joined yet: the place in the map is unknown");
  } else if (state.keyframes == 0) {
    status.summary(DiagnosticStatus::OK, "no keyframe yet");
  } else {
    status.summaryf(DiagnosticStatus::OK, "%zu keyframes, %zu loops", state.keyframes, state.loops);
  }
}

void MappingHealth::DescribeLoops(Status& status) {
  const LoopState state = engine_.state();
  const KeyframeQueue::Counters queue = queue_.counters();
  const std::lock_guard<std::mutex> lock(mutex_);
  Summarize(state, queue, status);
  reported_faults_ = state.unusable + queue.lost + queue.disk_errors;
  status.add("keyframes", state.keyframes);
  status.add("keyframes of the continued map", state.continued);
  status.add("keyframes unusable", state.unusable);
  status.add("last unusable keyframe", state.last_error);
  status.add("keyframes missing", state.missing + queue.lost);
  status.add("queue", queue.waiting);
  status.add("queue on disk", queue.on_disk);
  status.add("candidates", state.candidates);
  status.add("loops accepted", state.loops);
  status.add("joined", state.joined ? "yes" : "not joined yet");
  status.addf("last detection [ms]", "%.1f", state.detection_ms);
  status.addf("last optimisation [ms]", "%.1f", state.optimization_ms);
  status.add("last optimisation", state.optimization);
  const Eigen::Vector3d t = state.T_map_odom.translation();
  status.addf("position of odom in map [m]", "%.3f %.3f %.3f", t.x(), t.y(), t.z());
}

void MappingHealth::DescribeMap(Status& status) {
  const SaveOutcome last = saving_.last();
  if (!last.success && !last.message.empty()) {
    status.summary(DiagnosticStatus::ERROR, "map not saved: " + last.message);
  } else {
    status.summary(DiagnosticStatus::OK, last.success ? "map saved" : "not saved yet");
  }
  status.add("last save", last.message);
  status.add("working files", work_folder_);
  status.addf("working files [MB]", "%.1f", MegabytesIn(work_folder_));
  status.addf("memory [MB]", "%.1f", ResidentMegabytes());
}

}  // namespace hv::loop
