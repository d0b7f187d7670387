#include "hv_explore_sac/policy/policy_scale.h"

namespace hv::explore {
namespace {

// Of the benchmark, whose scale is one: constants, since policies that were trained depend on them.
constexpr double kViewRange = 70.0;  // cells
constexpr double kBlock = 4.0;       // cells

}  // namespace

// A border of n cells shows n / block points; in the benchmark it is n / unit cells long and shows
// n / (unit x kBlock).
PolicyScale::PolicyScale(const ExplorationConfig& config)
    : unit(static_cast<float>(config.viewpoint.view_range / kViewRange)),
      point(static_cast<float>(config.frontier.block * kViewRange /
                               (kBlock * config.viewpoint.view_range))) {}

}  // namespace hv::explore
