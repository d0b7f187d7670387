#include "hv_explore_sac/observation.h"

#include <algorithm>

namespace hv::explore {

int Observation::FirstHopTo(int index) const {
  int hop = index;
  while (hop != kRobot && node(hop).predecessor != kRobot) hop = node(hop).predecessor;
  return hop;
}

bool Observation::AnyUtility() const {
  return std::any_of(nodes.begin(), nodes.end(), [](const Node& node) { return node.utility > 0; });
}

}  // namespace hv::explore
