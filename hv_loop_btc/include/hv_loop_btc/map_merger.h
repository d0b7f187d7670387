#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "hv_core/config.h"
#include "hv_core/map_folder.h"
#include "hv_loop_btc/loop_closer.h"
#include "hv_loop_btc/map_builder.h"
#include "hv_loop_btc/session_join.h"

namespace hv::loop {

/// What merging reads of a configuration file: sections `loop` and `map`.
struct MapMergerConfig {
  LoopConfig loop;
  MapBuilderConfig map;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// One map that was joined to those before.
struct MergedSession {
  std::string path;
  SessionJoinResult join;
};

/// A map made of several.
struct MergedMap {
  std::string path;
  std::vector<MergedSession> sessions;  ///< without the first, in the order they were joined
  std::size_t keyframes = 0;
  std::size_t unplaced = 0;  ///< keyframes that no edge connects to the others: not in the cloud
  std::size_t points = 0;    ///< of the cloud
};

/// Joins the saved maps of several sessions into one, in the frame of the first. Not thread-safe.
class MapMerger {
 public:
  /// Called with what is being done and the share of it that is done, in [0, 1].
  using Progress = std::function<void(const std::string& stage, double share)>;

  explicit MapMerger(const MapMergerConfig& config) : config_(config) {}

  /// Checks all of `maps` (two at least), joins them, in any order in which each finds a place in
  /// those before, and writes the map folder `out`, atomically (see MapWriter). Throws InputError,
  /// and writes nothing, when a map is damaged or lacks parts, holds keyframes of another, or
  /// cannot be joined.
  MergedMap Merge(const std::vector<MapFolder>& maps, const std::string& out,
                  const Progress& progress = {}) const;

 private:
  SavedSession Join(const std::vector<MapFolder>& maps, const Progress& progress,
                    MergedMap& merged) const;
  void Save(const SavedSession& session, const MapManifest& first, const Progress& progress,
            MergedMap& merged) const;

  const MapMergerConfig config_;
};

}  // namespace hv::loop
