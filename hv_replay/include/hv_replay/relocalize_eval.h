#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hv_relocalize_ndt/relocalize_config.h"

namespace hv::replay {

/// What relocalisation is tried on.
struct RelocalizeTrials {
  std::string map;     ///< map folder, or PCD or PLY
  std::string clouds;  ///< folder of clouds to localise, in order of their names
  std::string poses;   ///< TUM file: their true poses, empty when they lie nowhere in the map
  /// TUM file: true poses, in the frame of `poses`, of the run that made the map. With it the map
  /// is laid over the truth by its keyframes; without, the frames are the same.
  std::string map_truth;
  int count = 0;  ///< trials, over the clouds again and again; 0: one a cloud
  struct Perturbation {
    double translation_m = 0.0;
    double rotation_deg = 0.0;
  };
  /// Guesses this far from the truth, in random directions; none: no guess.
  std::optional<Perturbation> perturbation;
  double guess_radius_m = 0.0;     ///< in which a guess is searched; 0: as configured
  double guess_heading_deg = 0.0;  ///< the same for its heading
  bool ndt_alone = false;  ///< the alignment from the guess alone, without search and refusal
  /// Share of the map that has changed: so many of its columns of 1.5 m change places. Its
  /// descriptors are not used then.
  double changed_share = 0.0;
  std::uint32_t seed = 1;
};

/// Figures of the trials.
struct RelocalizeSummary {
  std::size_t trials = 0;
  std::size_t answered = 0;   ///< localised, right or wrong
  std::size_t successes = 0;  ///< localised within 0.10 m and 3 deg (paper, Table 6)
  double rmse_m = 0.0;        ///< of the successes
  double mean_m = 0.0;
  /// Errors of the successes as a multiple of what the covariances let expect: 1 for covariances
  /// that are right, more where they promise too much.
  double error_in_sigmas = 0.0;
  double median_ms = 0.0;
  double max_ms = 0.0;
  double load_ms = 0.0;  ///< of the map
};

/// Runs the trials and writes one row each: cloud, guess, answer, error, time. Throws InputError.
RelocalizeSummary TryRelocalization(const RelocalizeTrials& trials,
                                    const relocalize::RelocalizeConfig& config,
                                    const std::string& csv);

}  // namespace hv::replay
