#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>

#include "hv_loop_btc/map_saver.h"
#include "hv_loop_btc/mapping_config.h"
#include "loop_engine.h"

namespace hv::loop {

/// How a save ended.
struct SaveOutcome {
  bool success = false;
  std::string message;  ///< one line: what is where, or what went wrong
  SavedMap map;
};

/// Saves the map while loop closing goes on: the state is copied under the lock of the engine, then
/// everything is built in the calling thread. One save at a time. Thread-safe.
class MapSaving {
 public:
  /// Called with stage and share. Returns false to give the save up.
  using Progress = std::function<bool(const char* stage, double share)>;

  /// `engine` must outlive this object. `map_path`: where maps are saved unless told otherwise; may
  /// be empty.
  MapSaving(const LoopEngine& engine, const MappingConfig& config, std::string map_path);

  /// Saves to `directory`, or to map_path when it is empty. Never throws.
  SaveOutcome Save(const std::string& directory, const Progress& progress = {});

  /// Saves to map_path before the process ends, unless all is saved already or nothing is there:
  /// first what must not be lost, which takes no time; then, while `seconds` are not over, the
  /// whole map.
  SaveOutcome SaveAtExit(double seconds);

  /// Ends the save that is under way, if any, and refuses others but SaveAtExit.
  void GiveUp();

  /// Of the last save that ended; message empty before.
  SaveOutcome last() const;

 private:
  SaveOutcome Run(const std::string& path, MapParts parts, const Progress& progress);

  const LoopEngine& engine_;
  const MapSaver saver_;
  const std::string map_path_;
  std::atomic<bool> give_up_{false};
  std::mutex saving_;  ///< held by the save that is under way

  mutable std::mutex mutex_;  // guards everything below
  SaveOutcome last_;
  std::uint64_t saved_revision_ = 0;  ///< that is whole at map_path
  bool saved_ = false;
};

}  // namespace hv::loop
