#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace hv {

/// Cell of a cubic grid.
struct Cube {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
};

/// 21 bits an axis: cubes within +-2^20 of the origin have keys of their own.
inline std::uint64_t CubeKey(const Cube& cube) {
  constexpr std::int32_t kOffset = 1 << 20;
  const auto part = [](std::int32_t cell) {
    return static_cast<std::uint64_t>(cell + kOffset) & 0x1FFFFFU;
  };
  return (part(cube.x) << 42U) | (part(cube.y) << 21U) | part(cube.z);
}

/// The cube that holds `point` [m]; one far outside of the keys for points that are nowhere.
inline Cube CubeOf(const Eigen::Vector3f& point, float inverse_size) {
  const auto cell = [inverse_size](float coordinate) {
    constexpr float kFarthest = 1e9F;
    const float whole = std::floor(coordinate * inverse_size);
    return static_cast<std::int32_t>(std::max(-kFarthest, std::min(kFarthest, whole)));
  };
  return {cell(point.x()), cell(point.y()), cell(point.z())};
}

inline std::uint64_t CubeKey(const Eigen::Vector3f& point, float inverse_size) {
  return CubeKey(CubeOf(point, inverse_size));
}

/// For hash tables whose size is a power of two: neighbouring keys differ in few bits.
struct CubeHash {
  std::size_t operator()(std::uint64_t key) const {
    key ^= key >> 31U;
    key *= 0x9E3779B97F4A7C15ULL;
    return key ^ (key >> 32U);
  }
};

}  // namespace hv
