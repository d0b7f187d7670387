#include "hv_loop_btc/loop_vote.h"

#include <algorithm>
#include <cmath>

#include "hv_core/angles.h"

namespace hv::loop {
namespace {

/// Odometry between the two submaps may add this to their disagreement.
constexpr double kDriftShare = 0.02;
constexpr double kDriftRadPerM = 0.3 * kRadiansPerDegree;

/// Where the candidate says that its newer submap is.
Pose Place(const LoopCandidate& candidate, const LoopVote::Poses& poses) {
  return poses(candidate.match) * candidate.T_match_query;
}

}  // namespace

void LoopVoteConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("sure_within_m", sure_within_m,
                "error of odometry up to which a single place is taken at once [m]");
  visitor.Field("window", window, "newest submaps that support each other");
  visitor.Field("confirmations", confirmations,
                "submaps that must ask for the same movement while odometry is uncertain");
  visitor.Field("margin", margin, "lead over the next best movement, share of its support");
  visitor.Field("agree_m", agree_m, "movements that differ less are the same [m]");
  visitor.Field("agree_deg", agree_deg, "the same for rotation [deg]");
}

void LoopVoteConfig::Validate(ConfigProblems& problems) const {
  problems.Require(sure_within_m >= 0.0, "vote.sure_within_m", "must not be negative");
  problems.Require(window >= 1, "vote.window", "must be at least 1");
  problems.Require(confirmations >= 1 && confirmations <= window, "vote.confirmations",
                   "must be at least 1 and at most vote.window");
  problems.Require(margin >= 0.0 && margin < 1.0, "vote.margin", "must be at least 0 and below 1");
  problems.Require(agree_m > 0.0, "vote.agree_m", "must be positive");
  problems.Require(agree_deg > 0.0, "vote.agree_deg", "must be positive");
}

bool LoopVote::Agree(const LoopCandidate& a, const LoopCandidate& b, const Poses& poses) const {
  const Pose T_a_b_odometry = poses(a.query).inverse() * poses(b.query);
  const Pose T_a_b = Place(a, poses).inverse() * Place(b, poses);
  const double apart = T_a_b_odometry.translation().norm();
  const Pose difference = T_a_b_odometry.inverse() * T_a_b;
  return difference.translation().norm() < config_.agree_m + kDriftShare * apart &&
         RotationDistance(T_a_b_odometry, T_a_b) <
             config_.agree_deg * kRadiansPerDegree + kDriftRadPerM * apart;
}

LoopVote::Support LoopVote::SupportOf(const LoopCandidate& candidate, const Poses& poses) const {
  Support support;
  for (std::size_t i = 0; i < ballots_.size(); ++i) {
    double best = 0.0;
    for (std::size_t j = 0; j < ballots_[i].candidates.size(); ++j) {
      const LoopCandidate& other = ballots_[i].candidates[j];
      if (!Agree(candidate, other, poses)) continue;
      if (!ballots_[i].decided) support.members.emplace_back(i, j);
      best = std::max(best, other.score());
    }
    support.score += best;
    support.ballots += best > 0.0 ? 1 : 0;
  }
  return support;
}

bool LoopVote::IsExpected(const LoopCandidate& candidate,
                          const Circumstances& circumstances) const {
  const Pose expected = circumstances.poses(candidate.query);
  const Pose place = Place(candidate, circumstances.poses);
  return (place.translation() - expected.translation()).norm() < circumstances.expected_m &&
         RotationDistance(place, expected) < config_.agree_deg * kRadiansPerDegree;
}

bool LoopVote::UniqueNow(const Ballot& ballot, const Poses& poses) const {
  const auto& all = ballot.candidates;
  return std::all_of(all.begin(), all.end(), [&](const LoopCandidate& candidate) {
    return Agree(all.front(), candidate, poses) ||
           candidate.score() < (1.0 - config_.margin) * all.front().score();
  });
}

std::vector<LoopCandidate> LoopVote::Count(const Circumstances& circumstances) {
  const Poses& poses = circumstances.poses;
  Support best;
  const LoopCandidate* winner = nullptr;
  for (const LoopCandidate& candidate : ballots_.back().candidates) {
    Support support = SupportOf(candidate, poses);
    if (winner != nullptr && support.score <= best.score) continue;
    best = std::move(support);
    winner = &candidate;
  }
  std::vector<std::size_t> voters;
  for (const auto& [ballot, number] : best.members) voters.push_back(ballot);
  voters.erase(std::unique(voters.begin(), voters.end()), voters.end());
  if (voters.size() < static_cast<std::size_t>(config_.confirmations)) return {};
  if (best.mean() < circumstances.confirm_score) return {};
  for (const Ballot& ballot : ballots_) {
    for (const LoopCandidate& rival : ballot.candidates) {
      if (Agree(*winner, rival, poses)) continue;
      if (SupportOf(rival, poses).score > (1.0 - config_.margin) * best.score) return {};
    }
  }
  std::vector<LoopCandidate> loops;
  for (const auto& [ballot, number] : best.members) {
    loops.push_back(ballots_[ballot].candidates[number]);
  }
  for (const std::size_t voter : voters) ballots_[voter].decided = true;
  return loops;
}

std::vector<LoopCandidate> LoopVote::Add(const std::vector<LoopCandidate>& candidates,
                                         const Circumstances& circumstances) {
  Ballot ballot;
  for (const LoopCandidate& candidate : candidates) {
    if (candidate.reason.empty()) ballot.candidates.push_back(candidate);
  }
  std::stable_sort(
      ballot.candidates.begin(), ballot.candidates.end(),
      [](const LoopCandidate& a, const LoopCandidate& b) { return a.score() > b.score(); });
  ballots_.push_back(std::move(ballot));
  while (ballots_.size() > static_cast<std::size_t>(config_.window)) ballots_.pop_front();
  Ballot& newest = ballots_.back();
  if (newest.candidates.empty()) return {};
  const Poses& poses = circumstances.poses;
  std::vector<LoopCandidate> loops;
  for (const LoopCandidate& candidate : newest.candidates) {
    if (IsExpected(candidate, circumstances)) loops.push_back(candidate);
  }
  newest.decided = !loops.empty();
  if (newest.decided) return loops;
  const bool sure = circumstances.uncertainty_m <= config_.sure_within_m &&
                    newest.candidates.front().score() >= circumstances.confirm_score;
  if (!sure || !UniqueNow(newest, poses)) return Count(circumstances);
  newest.decided = true;
  for (const LoopCandidate& candidate : newest.candidates) {
    if (Agree(newest.candidates.front(), candidate, poses)) loops.push_back(candidate);
  }
  return loops;
}

}  // namespace hv::loop
