#pragma once

#include "hv_core/se3.h"
#include "hv_relocalize_ndt/ndt_registration.h"
#include "hv_relocalize_ndt/place_score.h"
#include "hv_relocalize_ndt/prior_map.h"

namespace hv::relocalize {

/// A scan that has been aligned to the map, and how it fits there.
struct Refinement {
  NdtResult aligned;
  PlaceScore score;
};

/// Aligns a scan from a pose that is known to a metre and some degrees: with the fine levels of the
/// map, and with the finest alone, which reaches less far but is not drawn away by what stands
/// where nothing stood when the map was made. Returns what fits better. Pure.
Refinement Refine(const PriorMap& map, const NdtRegistration& registration, const NdtSource& source,
                  const PlaceJudge& judge, const Pose& T_map_scan);

}  // namespace hv::relocalize
