#include "hv_lio/match_monitor.h"

namespace hv::lio {
namespace {

/// Scans before anything is usual, and weight of each later one.
constexpr int kFewest = 10;
constexpr double kWeight = 0.1;

}  // namespace

bool MatchMonitor::Misfits(const UpdateSummary& update) const {
  return fitting_ >= kFewest &&
         static_cast<double>(update.residuals) < config_.misfit_share * usual_residuals_ &&
         update.mean_abs_residual_m > config_.misfit_ratio * usual_distance_m_;
}

bool MatchMonitor::IsLost(const UpdateSummary& update) {
  if (Misfits(update)) return ++misfitting_ >= config_.misfit_scans;
  misfitting_ = 0;
  const double weight = fitting_ < kFewest ? 1.0 / (fitting_ + 1) : kWeight;
  ++fitting_;
  usual_residuals_ += weight * (static_cast<double>(update.residuals) - usual_residuals_);
  usual_distance_m_ += weight * (update.mean_abs_residual_m - usual_distance_m_);
  return false;
}

void MatchMonitor::Restart() { *this = MatchMonitor(config_); }

}  // namespace hv::lio
