#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "hv_relocalize_ndt/localizer.h"
#include "hv_relocalize_ndt/prior_map.h"
#include "scan_queue.h"

namespace hv::relocalize {

/// What is known after a scan.
struct LocalizationReport {
  TrackedScanHeader scan;
  LocalizerUpdate update;
  Pose T_map_base = Pose::Identity();
  /// x y z rx ry rz of T_map_base, both parts in axes of the map [m^2, rad^2].
  Matrix6d covariance = Matrix6d::Zero();
  double elapsed_ms = 0.0;  ///< that it took
};

/// What the diagnostics tell.
struct LocalizationState {
  LocalizationReport last;
  LocalizerUpdate compared;  ///< of the last scan that was compared with the map
  std::size_t scans = 0;
  std::size_t comparisons = 0;
  std::size_t searches = 0;
  std::size_t losses = 0;  ///< times that the place was lost
  double comparison_ms = 0.0;
  double search_ms = 0.0;
};

/// Map and Localizer, and the requests to look for the place anew. `Add` is for one thread; all
/// else is thread-safe and never waits for a scan that is being processed.
class LocalizationEngine {
 public:
  /// Reads the map. Throws InputError.
  LocalizationEngine(const LocalizerConfig& config, const std::string& map_path);

  const PriorMap& map() const { return map_; }

  /// Takes the newest scan in, after those that it has overtaken.
  LocalizationReport Add(const ScanBatch& batch);

  /// About where the robot is, with PoseGuess::T_map_scan for the pose of its base; the next scan
  /// starts there if it fits.
  void SetGuess(const PoseGuess& guess);

  /// Forgets the place; the next scan is looked for near the guess, or anywhere. Returns a number
  /// for Answer().
  std::uint64_t Relocalize(const std::optional<PoseGuess>& guess);

  /// Whether that search is under way, or done.
  bool HasBegun(std::uint64_t number) const;

  /// The search that a call of Relocalize() has led to; nothing when it is not done within
  /// `seconds`. Its answer is that of the latest call when another one came before.
  std::optional<LocalizationReport> Answer(std::uint64_t number, double seconds);

  /// The caller waits no longer: what has not begun is not done.
  void Cancel(std::uint64_t number);

  LocalizationState state() const;

 private:
  /// What the next scan is to begin with.
  struct Request {
    std::optional<PoseGuess> guess;  ///< of the base
    bool forget = false;
  };

  LocalizerUpdate Localize(const ScanBatch& batch);
  void Begin(const TrackedScanHeader& scan);
  void Note(const LocalizationReport& report);

  const PriorMap map_;
  Localizer localizer_;  // of the thread that adds

  mutable std::mutex mutex_;  // guards everything below
  std::condition_variable answered_;
  Request request_;
  std::uint64_t requests_ = 0;  ///< asked for
  std::uint64_t begun_ = 0;     ///< of these, handed to the localizer
  std::uint64_t done_ = 0;      ///< of these, answered
  LocalizationReport answer_;
  LocalizationState state_;
};

}  // namespace hv::relocalize
