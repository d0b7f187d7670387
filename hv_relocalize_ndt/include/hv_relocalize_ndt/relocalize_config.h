#pragma once

#include "hv_core/config.h"
#include "hv_relocalize_ndt/ndt_registration.h"
#include "hv_relocalize_ndt/place_score.h"
#include "hv_relocalize_ndt/pose_search.h"

namespace hv::relocalize {

/// When a place counts as found.
struct AcceptanceConfig {
  double min_fit = 0.75;
  double min_fit_anywhere = 0.85;
  double min_overlap = 0.7;
  double max_seen_through = 0.1;
  double min_lead = 2.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// Everything that relocalisation can be told.
struct RelocalizeConfig {
  NdtConfig ndt;
  PoseSearchConfig search;
  PlaceScoreConfig score;
  AcceptanceConfig accept;
  int descriptor_candidates = 5;
  double guess_radius_m = 18.0;
  double guess_heading_deg = 25.0;
  double covariance_scale = 20.0;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::relocalize
