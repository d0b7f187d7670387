#include "hv_relocalize_ndt/global_localizer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <Eigen/Cholesky>

namespace hv::relocalize {
namespace {

constexpr double kRadians = M_PI / 180.0;
/// Levels finer than this refine hypotheses of the search, which are right to a cube and a few
/// degrees.
constexpr double kSearchBasin_m = 4.0;

bool SamePlace(const Pose& a, const Pose& b, const PoseSearchConfig& config) {
  return (a.translation() - b.translation()).norm() < config.same_place_m &&
         RotationDistance(a, b) < config.same_heading_deg * kRadians;
}

double YawOf(const Eigen::Matrix3d& rotation) { return std::atan2(rotation(1, 0), rotation(0, 0)); }

std::string Percent(double share) {
  char text[16];
  std::snprintf(text, sizeof(text), "%.0f %%", 100.0 * share);
  return text;
}

}  // namespace

/// The query, prepared once for all candidates.
struct GlobalLocalizer::Scan {
  const std::vector<Eigen::Vector3f>& points;
  NdtSource source;
  NdtLevel surfaces;
  Eigen::Vector3d up;
  Eigen::Matrix3d R_level_scan;
};

GlobalLocalizer::Scan GlobalLocalizer::Prepare(const LocalizationQuery& query) const {
  Scan scan{query.points, NdtSource(config_.ndt, query.points),
            NdtLevel(config_.search.cell_m, query.points), Eigen::Vector3d::UnitZ(),
            Eigen::Matrix3d::Identity()};
  if (query.up) {
    scan.up = query.up->normalized();
  } else {
    const Eigen::Vector3d guess =
        query.T_map_scan_guess
            ? Eigen::Vector3d(query.T_map_scan_guess->linear().transpose().col(2))
            : Eigen::Vector3d::UnitZ();
    scan.up = EstimateUp(scan.surfaces, guess);
  }
  scan.R_level_scan = UprightRotation(scan.up);
  return scan;
}

PoseWindow GlobalLocalizer::WindowFor(const LocalizationQuery& query, const Scan& scan) const {
  PoseWindow window;
  if (query.T_map_scan_guess) {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(config_.guess_radius_m);
    window.low = query.T_map_scan_guess->translation() - reach;
    window.high = query.T_map_scan_guess->translation() + reach;
    window.yaw_rad = YawOf(query.T_map_scan_guess->linear() * scan.R_level_scan.transpose());
    window.yaw_range_rad = config_.guess_heading_deg * kRadians;
    return window;
  }
  const StructureGrid& grid = map_.structure();
  window.low = grid.origin();
  window.high = grid.origin() + grid.cell_m() * grid.size().cast<double>();
  window.yaw_range_rad = M_PI;
  return window;
}

std::vector<LocalizationCandidate> GlobalLocalizer::Propose(const LocalizationQuery& query,
                                                            const Scan& scan) const {
  std::vector<LocalizationCandidate> candidates;
  if (query.T_map_scan_guess) {
    candidates.push_back({*query.T_map_scan_guess, "guess", {}});
  }
  const PoseSearch search(config_.search, map_.structure());
  const std::vector<PoseHypothesis> hypotheses =
      search.Find(StructureCells(scan.surfaces, scan.R_level_scan), WindowFor(query, scan));
  for (const PoseHypothesis& hypothesis : hypotheses) {
    Pose T_map_scan = hypothesis.T_map_level;
    T_map_scan.linear() = T_map_scan.linear() * scan.R_level_scan;
    candidates.push_back({T_map_scan, "search", {}});
  }
  return candidates;
}

void GlobalLocalizer::Refine(const Scan& scan,
                             std::vector<LocalizationCandidate>& candidates) const {
  const PlaceJudge judge(config_.score, map_.surfaces(), scan.surfaces, scan.points, scan.up);
  std::vector<const NdtLevel*> fine;
  for (const NdtLevel* level : map_.Levels()) {
    if (level->resolution_m() < kSearchBasin_m || level == map_.Levels().back()) {
      fine.push_back(level);
    }
  }
  for (LocalizationCandidate& candidate : candidates) {
    const auto levels = candidate.origin == "guess" ? map_.Levels() : fine;
    candidate.T_map_scan =
        registration_.Align(levels, scan.source, candidate.T_map_scan).T_target_source;
    candidate.score = judge.Judge(candidate.T_map_scan);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const LocalizationCandidate& a, const LocalizationCandidate& b) {
                     return a.score.score() > b.score.score();
                   });
}

void GlobalLocalizer::Decide(const Scan& scan, LocalizationResult& result) const {
  if (result.candidates.empty()) {
    result.reason = "the scan has no structure to compare";
    return;
  }
  const LocalizationCandidate& best = result.candidates.front();
  result.T_map_scan = best.T_map_scan;
  result.score = best.score;
  result.margin = best.score.score() -
                  (result.candidates.size() > 1 ? result.candidates[1].score.score() : 0.0);
  const NdtResult last = registration_.Align({map_.Levels().back()}, scan.source, best.T_map_scan);
  result.T_map_scan = last.T_target_source;
  result.covariance =
      config_.covariance_scale * last.hessian.ldlt().solve(Matrix6d(Matrix6d::Identity()));
  const AcceptanceConfig& accept = config_.accept;
  if (best.score.overlap < accept.min_overlap) {
    result.reason = "the map knows only " + Percent(best.score.overlap) +
                    " of what the scan sees at the best place";
  } else if (best.score.fit < accept.min_fit) {
    result.reason = "only " + Percent(best.score.fit) + " of the scan fits at the best place";
  } else if (best.score.seen_through > accept.max_seen_through) {
    result.reason = "the scan sees through " + Percent(best.score.seen_through) +
                    " of the map at the best place";
  } else if (result.margin < accept.margin) {
    result.reason = "another place fits nearly as well";
  }
  result.localized = result.reason.empty();
}

LocalizationResult GlobalLocalizer::Locate(const LocalizationQuery& query) const {
  const Scan scan = Prepare(query);
  std::vector<LocalizationCandidate> candidates = Propose(query, scan);
  Refine(scan, candidates);
  LocalizationResult result;
  for (const LocalizationCandidate& candidate : candidates) {
    const bool known =
        std::any_of(result.candidates.begin(), result.candidates.end(), [&](const auto& other) {
          return SamePlace(candidate.T_map_scan, other.T_map_scan, config_.search);
        });
    if (!known) result.candidates.push_back(candidate);
  }
  Decide(scan, result);
  return result;
}

}  // namespace hv::relocalize
