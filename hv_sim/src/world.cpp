#include "hv_sim/world.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "hv_core/error.h"
#include "hv_sim/floor_plan.h"
#include "worlds/worlds.h"

namespace hv::sim {
namespace {

struct Entry {
  const char* name;
  World (*make)(std::uint32_t seed);
};

constexpr std::array<Entry, 7> kWorlds = {{{"office", MakeOffice},
                                           {"corridor", MakeCorridor},
                                           {"construction", MakeConstruction},
                                           {"warehouse", MakeWarehouse},
                                           {"campus", MakeCampus},
                                           {"tunnel", MakeTunnel},
                                           {"tunnel_straight", MakeStraightTunnel}}};

/// Levenshtein distance.
std::size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0U : 1U);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

bool IsYamlPath(const std::string& name) {
  const auto ends_with = [&name](const std::string& tail) {
    return name.size() > tail.size() &&
           name.compare(name.size() - tail.size(), tail.size(), tail) == 0;
  };
  return ends_with(".yaml") || ends_with(".yml");
}

[[noreturn]] void ThrowUnknown(const std::string& name) {
  const Entry& nearest =
      *std::min_element(kWorlds.begin(), kWorlds.end(), [&name](const Entry& a, const Entry& b) {
        return EditDistance(name, a.name) < EditDistance(name, b.name);
      });
  throw InputError("unknown world '" + name + "', did you mean '" + nearest.name +
                   "'? (a floor plan needs the path of its .yaml)");
}

}  // namespace

std::vector<std::string> WorldNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kWorlds) names.emplace_back(entry.name);
  return names;
}

World MakeWorld(const std::string& name, std::uint32_t seed) {
  if (IsYamlPath(name)) return ExtrudeFloorPlan(ReadFloorPlan(name), seed);
  for (const Entry& entry : kWorlds) {
    if (name == entry.name) return entry.make(seed);
  }
  ThrowUnknown(name);
}

}  // namespace hv::sim
