#include "localization_health.h"

#include <cmath>

#include "hv_core/angles.h"
#include "hv_core/memory.h"
#include "pose_message.h"

namespace hv::relocalize {
namespace {

using diagnostic_msgs::DiagnosticStatus;

/// Standard deviation of a block of a covariance.
double Sigma(const Matrix6d& covariance, int first) {
  return std::sqrt(covariance.block<3, 3>(first, first).trace());
}

void AddComparison(const LocalizerUpdate& compared,
                   diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.addf("fit", "%.3f", compared.score.fit);
  status.addf("overlap", "%.3f", compared.score.overlap);
  status.addf("seen through", "%.3f", compared.score.seen_through);
  status.addf("innovation [sigma]", "%.2f", std::sqrt(compared.innovation));
}

}  // namespace

LocalizationHealth::LocalizationHealth(const LocalizationEngine& engine, const ScanQueue& queue)
    : engine_(engine), queue_(queue) {}

void LocalizationHealth::SetProblem(const std::string& problem) {
  const std::lock_guard<std::mutex> lock(mutex_);
  problem_ = problem;
}

void LocalizationHealth::OnUnusable(const std::string& error) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++unusable_;
  last_error_ = error;
}

void LocalizationHealth::Summarize(const LocalizationState& state, Status& status) const {
  const LocalizerUpdate& update = state.last.update;
  if (!problem_.empty()) {
    status.summary(DiagnosticStatus::ERROR, problem_);
  } else if (state.scans == 0) {
    status.summary(DiagnosticStatus::WARN, "lost: no scan yet");
  } else if (update.state == LocalizerState::kLost) {
    status.summary(DiagnosticStatus::ERROR, "lost: " + update.reason);
  } else if (update.state == LocalizerState::kDeadReckoning) {
    status.summary(DiagnosticStatus::WARN, "dead reckoning: " + update.reason);
  } else if (unusable_ > reported_unusable_) {
    status.summary(DiagnosticStatus::WARN, last_error_);
  } else {
    status.summary(DiagnosticStatus::OK, "tracking");
  }
}

void LocalizationHealth::DescribeLocalization(Status& status) {
  const LocalizationState state = engine_.state();
  const std::lock_guard<std::mutex> lock(mutex_);
  Summarize(state, status);
  reported_unusable_ = unusable_;
  const LocalizerUpdate& update = state.last.update;
  const bool lost = update.state == LocalizerState::kLost;
  status.add("state", ToString(update.state));
  status.add("reason", update.reason);
  status.add("place of the base", lost ? "unknown" : PlaceOf(state.last.T_map_base));
  status.addf("sigma of the position [m]", "%.4f", lost ? 0.0 : Sigma(state.last.covariance, 0));
  status.addf("sigma of the rotation [deg]", "%.4f",
              lost ? 0.0 : kDegreesPerRadian * Sigma(state.last.covariance, 3));
  status.add("least certain", lost ? "everything" : WeakestOf(state.last.covariance));
  AddComparison(state.compared, status);
  status.addf("last comparison [ms]", "%.1f", state.comparison_ms);
  status.addf("last search [ms]", "%.1f", state.search_ms);
  status.add("scans", state.scans);
  status.add("scans dropped", queue_.dropped());
  status.add("scans unusable", unusable_);
  status.add("last unusable scan", last_error_);
  status.add("comparisons", state.comparisons);
  status.add("searches", state.searches);
  status.add("losses", state.losses);
}

void LocalizationHealth::DescribeMap(Status& status) {
  const PriorMap& map = engine_.map();
  status.summary(DiagnosticStatus::OK, "map loaded");
  status.add("map", map.name());
  status.add("points", map.points().size());
  status.add("keyframes", map.session() ? map.session()->graph.vertices.size() : 0);
  status.addf("memory [MB]", "%.1f", ResidentMegabytes());
}

}  // namespace hv::relocalize
