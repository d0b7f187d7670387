#include "hv_relocalize_ndt/global_localizer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "hv_core/angles.h"
#include "hv_relocalize_ndt/refinement.h"

namespace hv::relocalize {
namespace {

bool SamePlace(const Pose& a, const Pose& b, const PoseSearchConfig& config) {
  return (a.translation() - b.translation()).norm() < config.same_place_m &&
         RotationDistance(a, b) < config.same_heading_deg * kRadiansPerDegree;
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
  Scan(const RelocalizeConfig& config, const NdtLevel& map, const LocalizationQuery& query)
      : points(query.points),
        source(config.ndt, query.points),
        surfaces(map.resolution_m(), query.points),
        up(UpOf(query, surfaces)),
        R_level_scan(UprightRotation(up)),
        structure(StructureCells(surfaces, R_level_scan)),
        judge(config.score, map, surfaces, query.points, up) {}

  static Eigen::Vector3d UpOf(const LocalizationQuery& query, const NdtLevel& surfaces) {
    if (query.up) return query.up->normalized();
    Eigen::Vector3d guess = Eigen::Vector3d::UnitZ();
    if (query.guess) guess = query.guess->T_map_scan.linear().row(2);
    return EstimateUp(surfaces, guess);
  }

  const std::vector<Eigen::Vector3f>& points;
  NdtSource source;
  NdtLevel surfaces;
  Eigen::Vector3d up;
  Eigen::Matrix3d R_level_scan;
  std::vector<StructureCell> structure;
  PlaceJudge judge;
};

PoseWindow GlobalLocalizer::WindowFor(const LocalizationQuery& query, const Scan& scan) const {
  PoseWindow window;
  if (query.guess) {
    const PoseGuess& guess = *query.guess;
    const double radius_m = guess.radius_m > 0.0 ? guess.radius_m : config_.guess_radius_m;
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius_m);
    window.low = guess.T_map_scan.translation() - reach;
    window.high = guess.T_map_scan.translation() + reach;
    window.yaw_rad = YawOf(guess.T_map_scan.linear() * scan.R_level_scan.transpose());
    window.yaw_range_rad =
        guess.heading_rad > 0.0 ? guess.heading_rad : config_.guess_heading_deg * kRadiansPerDegree;
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
  const PoseWindow window = WindowFor(query, scan);
  if (query.guess) {
    candidates.push_back({query.guess->T_map_scan, "guess", {}});
  } else {
    candidates = ProposeByDescriptors(scan);
  }
  const PoseSearch search(config_.search, map_.structure());
  for (const PoseHypothesis& hypothesis : search.Find(scan.structure, window)) {
    Pose T_map_scan = hypothesis.T_map_level;
    T_map_scan.linear() = T_map_scan.linear() * scan.R_level_scan;
    candidates.push_back({T_map_scan, "search", {}});
  }
  return candidates;
}

/// Places whose boundary triangles resemble those of the scan (paper 3.2).
std::vector<LocalizationCandidate> GlobalLocalizer::ProposeByDescriptors(const Scan& scan) const {
  std::vector<LocalizationCandidate> candidates;
  for (const Pose& pose : map_.PlacesLike(scan.points, scan.up)) {
    candidates.push_back({pose, "descriptors", {}});
  }
  return candidates;
}

void GlobalLocalizer::FollowUp(const Scan& scan,
                               std::vector<LocalizationCandidate>& candidates) const {
  for (LocalizationCandidate& candidate : candidates) {
    if (candidate.origin == "guess") {
      candidate.T_map_scan =
          registration_.Align(map_.Levels(), scan.source, candidate.T_map_scan).T_target_source;
    }
    const Refinement refined =
        Refine(map_, registration_, scan.source, scan.judge, candidate.T_map_scan);
    candidate.T_map_scan = refined.aligned.T_target_source;
    candidate.score = refined.score;
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const LocalizationCandidate& a, const LocalizationCandidate& b) {
                     return a.score.score() > b.score.score();
                   });
}

/// Pose, covariance and lead of the best candidate.
void GlobalLocalizer::Measure(const Scan& scan, LocalizationResult& result) const {
  const LocalizationCandidate& best = result.candidates.front();
  const NdtResult last = registration_.Align({map_.Levels().back()}, scan.source, best.T_map_scan);
  result.T_map_scan = last.T_target_source;
  result.covariance = CovarianceOf(last, config_.covariance_scale);
  result.score = best.score;
  result.margin = best.score.score();
  result.lead = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < result.candidates.size(); ++i) {
    const LocalizationCandidate& other = result.candidates[i];
    result.margin = std::min(result.margin, best.score.score() - other.score.score());
    result.lead = std::min(result.lead, scan.judge.Lead(best.T_map_scan, other.T_map_scan));
  }
}

/// Empty when the place counts as found.
std::string GlobalLocalizer::WhyNot(const LocalizationResult& result, double min_fit) const {
  const AcceptanceConfig& accept = config_.accept;
  if (result.score.overlap < accept.min_overlap) {
    return "the map knows only " + Percent(result.score.overlap) +
           " of what the scan sees at the best place";
  }
  if (result.score.fit < min_fit) {
    return "only " + Percent(result.score.fit) + " of the scan fits at the best place";
  }
  if (result.score.seen_through > accept.max_seen_through) {
    return "the scan sees through " + Percent(result.score.seen_through) +
           " of the map at the best place";
  }
  if (result.lead < accept.min_lead) return "another place fits nearly as well";
  return "";
}

LocalizationResult GlobalLocalizer::Locate(const LocalizationQuery& query) const {
  const Scan scan(config_, map_.surfaces(), query);
  std::vector<LocalizationCandidate> candidates = Propose(query, scan);
  FollowUp(scan, candidates);
  LocalizationResult result;
  for (const LocalizationCandidate& candidate : candidates) {
    const bool known =
        std::any_of(result.candidates.begin(), result.candidates.end(), [&](const auto& other) {
          return SamePlace(candidate.T_map_scan, other.T_map_scan, config_.search);
        });
    if (!known) result.candidates.push_back(candidate);
  }
  if (result.candidates.empty()) {
    const bool flat = std::all_of(scan.structure.begin(), scan.structure.end(),
                                  [](const StructureCell& cell) { return cell.level; });
    result.reason =
        flat ? "the scan has no structure to compare" : "nothing in the map resembles the scan";
    return result;
  }
  Measure(scan, result);
  const AcceptanceConfig& accept = config_.accept;
  result.reason = WhyNot(result, query.guess ? accept.min_fit : accept.min_fit_anywhere);
  result.localized = result.reason.empty();
  return result;
}

}  // namespace hv::relocalize
