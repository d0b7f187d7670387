#pragma once

#include <string>

#include "voxel_space.h"

namespace hv::loop {

/// Writes an OctoMap (.bt): voxels with a surface that is not moving are occupied, others that rays
/// passed are free. Blocks beyond the reach of OctoMap's 16-bit keys are left out. Throws
/// InputError when the file cannot be written.
void WriteOcTree(const VoxelSpace& space, const std::string& path);

}  // namespace hv::loop
