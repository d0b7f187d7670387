#include "map_saving.h"

#include <chrono>
#include <utility>

#include "hv_core/elapsed.h"

namespace hv::loop {
namespace {

using Clock = std::chrono::steady_clock;

SaveOutcome Failure(const std::string& message) { return {false, message, {}}; }

/// Ends a save early.
struct GivenUp {};

}  // namespace

MapSaving::MapSaving(const LoopEngine& engine, const MappingConfig& config, std::string map_path)
    : engine_(engine), saver_(config.map, ToYaml(config)), map_path_(std::move(map_path)) {}

SaveOutcome MapSaving::Save(const std::string& directory, const Progress& progress) {
  const std::string& path = directory.empty() ? map_path_ : directory;
  if (path.empty()) return Failure("no folder is named and the parameter map_path is not set");
  if (path.front() != '/') return Failure("'" + path + "' is not an absolute path");
  const std::unique_lock<std::mutex> lock(saving_, std::try_to_lock);
  if (!lock.owns_lock()) return Failure("another save is under way");
  if (give_up_) return Failure("the node is ending");
  return Run(path, MapParts::kAll, [this, &progress](const char* stage, double share) {
    return !give_up_ && (!progress || progress(stage, share));
  });
}

SaveOutcome MapSaving::SaveAtExit(double seconds) {
  const Clock::time_point start = Clock::now();
  const std::lock_guard<std::mutex> lock(saving_);
  const LoopState state = engine_.state();
  {
    const std::lock_guard<std::mutex> state_lock(mutex_);
    if (saved_ && saved_revision_ == state.revision) return last_;
  }
  if (map_path_.empty() || state.keyframes == state.continued) return {};
  const SaveOutcome essential =
      Run(map_path_, MapParts::kEssential, [](const char*, double) { return true; });
  if (!essential.success) return essential;
  // Writing the whole map takes as long again as writing its essential part, and more for the
  // cloud.
  const double build_until = seconds - 2.0 * SecondsSince(start);
  SaveOutcome whole = Run(map_path_, MapParts::kAll, [&](const char* stage, double) {
    return SecondsSince(start) < build_until || std::string(stage) == "writing";
  });
  if (whole.success) return whole;
  whole = essential;
  whole.message += " (without cloud, grid and OctoMap: no time was left)";
  const std::lock_guard<std::mutex> state_lock(mutex_);
  return last_ = whole;
}

void MapSaving::GiveUp() { give_up_ = true; }

SaveOutcome MapSaving::last() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return last_;
}

SaveOutcome MapSaving::Run(const std::string& path, MapParts parts, const Progress& progress) {
  const std::uint64_t revision = engine_.state().revision;
  SaveOutcome outcome;
  try {
    outcome.map = saver_.Save(engine_.Snapshot(), engine_.store(), path, parts,
                              [&progress](const char* stage, double share) {
                                if (!progress(stage, share)) throw GivenUp();
                              });
    outcome.success = true;
    outcome.message = outcome.map.ToString();
  } catch (const InputError& error) {
    outcome = Failure(error.what());
  } catch (const GivenUp&) {
    outcome = Failure("given up before the end");
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  last_ = outcome;
  if (outcome.success && parts == MapParts::kAll && path == map_path_) {
    saved_ = true;
    saved_revision_ = revision;
  }
  return outcome;
}

}  // namespace hv::loop
