#include "hv_loop_btc/session_join.h"

#include <utility>

#include "join_attempt.h"

namespace hv::loop {

SessionJoin::SessionJoin(const LoopConfig& config, SavedSession first)
    : config_(config), joined_(std::move(first)) {}

SessionJoinResult SessionJoin::Add(const SavedSession& session, const Progress& progress) {
  const SavedSession added = NumberedAfter(joined_, session);
  JoinAttempt attempt(config_, joined_, added, progress);
  const SessionJoinResult result = attempt.Run();
  if (result.joined) joined_ = attempt.Joined();
  return result;
}

}  // namespace hv::loop
