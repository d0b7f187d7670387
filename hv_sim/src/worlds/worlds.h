#pragma once

#include <cstdint>

#include "hv_sim/world.h"

namespace hv::sim {

World MakeOffice(std::uint32_t seed);
World MakeCorridor(std::uint32_t seed);
World MakeConstruction(std::uint32_t seed);
World MakeWarehouse(std::uint32_t seed);
World MakeCampus(std::uint32_t seed);
World MakeTunnel(std::uint32_t seed);
World MakeStraightTunnel(std::uint32_t seed);

}  // namespace hv::sim
