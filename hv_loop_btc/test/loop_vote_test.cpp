#include "hv_loop_btc/loop_vote.h"

#include <gtest/gtest.h>

namespace hv::loop {
namespace {

/// Keyframe `id` believed at x = id metres, straight on; the map is as odometry says.
Pose Believed(std::uint32_t id) { return MakePose(Eigen::Matrix3d::Identity(), {1.0 * id, 0, 0}); }

/// A candidate that says keyframe `query` is `shift` metres to the left of where it is believed.
LoopCandidate Asks(std::uint32_t query, double shift, double score) {
  LoopCandidate candidate;
  candidate.query = query;
  candidate.match = query - 100;
  candidate.T_match_query = MakePose(Eigen::Matrix3d::Identity(), {100.0, shift, 0.0});
  candidate.fitness = score;
  candidate.overlap = 1.0;
  return candidate;
}

LoopVote::Circumstances Circumstances(double uncertainty_m, double expected_m = 0.0) {
  return {uncertainty_m, expected_m, 0.5, Believed};
}

TEST(LoopVoteTest, WhereOdometryIsCertainOneGoodCandidateIsEnough) {
  LoopVote vote{LoopVoteConfig()};
  const auto loops = vote.Add({Asks(200, 0.1, 0.6)}, Circumstances(1.0));
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].query, 200U);
}

TEST(LoopVoteTest, WhereOdometryIsUncertainOthersMustConfirm) {
  const LoopVoteConfig config;
  LoopVote vote(config);
  std::size_t accepted = 0;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(config.confirmations); ++i) {
    const auto loops = vote.Add({Asks(200 + 3 * i, 5.0, 0.6)}, Circumstances(20.0));
    accepted += loops.size();
    if (i + 1 < static_cast<std::uint32_t>(config.confirmations)) {
      EXPECT_TRUE(loops.empty());
    }
  }
  EXPECT_EQ(accepted, static_cast<std::size_t>(config.confirmations));
}

TEST(LoopVoteTest, EquallyGoodMovementsAreNotChosenBetween) {
  LoopVote vote{LoopVoteConfig()};
  for (std::uint32_t i = 0; i < 12; ++i) {
    const std::uint32_t query = 200 + 3 * i;
    EXPECT_TRUE(
        vote.Add({Asks(query, 0.0, 0.62), Asks(query, 6.0, 0.6)}, Circumstances(20.0)).empty());
  }
}

TEST(LoopVoteTest, TheBetterSupportedMovementWins) {
  LoopVote vote{LoopVoteConfig()};
  std::vector<LoopCandidate> accepted;
  for (std::uint32_t i = 0; i < 12; ++i) {
    const std::uint32_t query = 200 + 3 * i;
    std::vector<LoopCandidate> candidates = {Asks(query, 4.0, 0.6)};
    if (i % 2 == 0) candidates.push_back(Asks(query, -3.0 - i, 0.7));
    const auto loops = vote.Add(candidates, Circumstances(20.0));
    accepted.insert(accepted.end(), loops.begin(), loops.end());
  }
  EXPECT_GE(accepted.size(), 8U);
  for (const LoopCandidate& loop : accepted) EXPECT_EQ(loop.T_match_query.translation().y(), 4.0);
}

TEST(LoopVoteTest, PoorAlignmentsDoNotConfirmEachOther) {
  LoopVote vote{LoopVoteConfig()};
  for (std::uint32_t i = 0; i < 12; ++i) {
    EXPECT_TRUE(vote.Add({Asks(200 + 3 * i, 5.0, 0.4)}, Circumstances(20.0)).empty());
  }
}

TEST(LoopVoteTest, ThePlaceThatOdometryLeadsToIsTakenAtOnceEvenWithALowScore) {
  LoopVote vote{LoopVoteConfig()};
  EXPECT_TRUE(vote.Add({Asks(200, 0.1, 0.2)}, Circumstances(20.0)).empty());
  EXPECT_TRUE(vote.Add({Asks(203, 0.6, 0.2)}, Circumstances(20.0, 0.3)).empty());
  EXPECT_EQ(vote.Add({Asks(206, 6.0, 0.4), Asks(206, 0.1, 0.2)}, Circumstances(20.0, 0.3)).size(),
            1U);
}

TEST(LoopVoteTest, CandidatesWithAReasonHaveNoVote) {
  LoopVote vote{LoopVoteConfig()};
  LoopCandidate refused = Asks(200, 0.1, 0.9);
  refused.reason = "submaps do not fit";
  EXPECT_TRUE(vote.Add({refused}, Circumstances(1.0)).empty());
  EXPECT_TRUE(vote.Add({}, Circumstances(1.0)).empty());
}

}  // namespace
}  // namespace hv::loop
