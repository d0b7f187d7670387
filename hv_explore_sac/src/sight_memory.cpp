#include "hv_explore_sac/sight_memory.h"

namespace hv::explore {

void SightMemory::Sense(const Eigen::Vector2i& from, Belief& belief) {
  const auto [known, is_new] = seen_from_.try_emplace(map_.IndexOf(from));
  if (is_new) known->second = Look(from);
  for (const Sight& sight : known->second) {
    belief.Set(sight.cell, sight.is_free ? Cell::kFree : Cell::kOccupied);
  }
}

std::vector<SightMemory::Sight> SightMemory::Look(const Eigen::Vector2i& from) const {
  std::vector<char> noted(map_.free.size(), 0);
  std::vector<Sight> sights;
  sensor_.Cast(map_, from, [&](int cell, bool is_free) {
    char& mark = noted[static_cast<std::size_t>(cell)];
    if (mark == 0) sights.push_back({cell, is_free});
    mark = 1;
  });
  sights.shrink_to_fit();
  return sights;
}

}  // namespace hv::explore
