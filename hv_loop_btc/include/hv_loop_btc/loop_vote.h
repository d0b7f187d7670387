#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <vector>

#include "hv_core/config.h"
#include "hv_loop_btc/loop_candidate.h"

namespace hv::loop {

struct LoopVoteConfig {
  double sure_within_m = 2.5;
  int window = 12;
  int confirmations = 4;
  double margin = 0.15;
  double agree_m = 0.5;
  double agree_deg = 3.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Decides which candidates are loops. Places can look alike, corridors above all, so one good
/// alignment is not enough while odometry allows several. Every candidate says how the map has to
/// move for its place to fit; those of consecutive submaps that ask for the same movement support
/// each other, and the movement that is best supported, by a margin over every other, wins.
/// Where odometry is certain enough to leave one place only, that place is taken at once, and so is
/// the place that odometry leads to, once loops have shown how good odometry is.
/// Not thread-safe.
class LoopVote {
 public:
  /// Pose in the map of a keyframe, as believed now.
  using Poses = std::function<Pose(std::uint32_t)>;

  /// What the candidates are judged by.
  struct Circumstances {
    double uncertainty_m = 0.0;  ///< how far odometry may be off
    double expected_m = 0.0;     ///< how far loops have shown it to be off, at most; 0: unknown
    double confirm_score = 0.0;  ///< mean score that loops need while it is uncertain
    Poses poses;
  };

  explicit LoopVote(const LoopVoteConfig& config) : config_(config) {}

  /// Takes the aligned candidates of one submap. Returns those that are loops, also of earlier
  /// submaps; each is returned once.
  std::vector<LoopCandidate> Add(const std::vector<LoopCandidate>& candidates,
                                 const Circumstances& circumstances);

 private:
  /// The candidates of one submap.
  struct Ballot {
    std::vector<LoopCandidate> candidates;
    bool decided = false;
  };
  /// A candidate and those that ask for the same movement, at most one a submap.
  struct Support {
    std::vector<std::pair<std::size_t, std::size_t>> members;  ///< ballot, candidate
    double score = 0.0;                                        ///< sum of the best of each submap
    std::size_t ballots = 0;                                   ///< submaps that agree

    double mean() const { return score / static_cast<double>(ballots); }
  };

  bool Agree(const LoopCandidate& a, const LoopCandidate& b, const Poses& poses) const;
  Support SupportOf(const LoopCandidate& candidate, const Poses& poses) const;
  bool IsExpected(const LoopCandidate& candidate, const Circumstances& circumstances) const;
  bool UniqueNow(const Ballot& ballot, const Poses& poses) const;
  std::vector<LoopCandidate> Count(const Circumstances& circumstances);

  LoopVoteConfig config_;
  std::deque<Ballot> ballots_;  ///< newest last
};

}  // namespace hv::loop
