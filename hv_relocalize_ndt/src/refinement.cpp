#include "hv_relocalize_ndt/refinement.h"

namespace hv::relocalize {

Refinement Refine(const PriorMap& map, const NdtRegistration& registration, const NdtSource& source,
                  const PlaceJudge& judge, const Pose& T_map_scan) {
  Refinement best;
  best.aligned = registration.Align({map.Levels().back()}, source, T_map_scan);
  best.score = judge.Judge(best.aligned.T_target_source);
  Refinement other;
  other.aligned = registration.Align(map.FineLevels(), source, T_map_scan);
  other.score = judge.Judge(other.aligned.T_target_source);
  return other.score.score() > best.score.score() ? other : best;
}

}  // namespace hv::relocalize
