#include "hv_relocalize_ndt/ndt_cache.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "hv_core/binary_io.h"
#include "hv_core/error.h"
#include "hv_core/file_io.h"

namespace hv::relocalize {
namespace {

constexpr char kMagic[8] = {'H', 'V', 'N', 'D', 'T', 'L', 'E', 'V'};
/// Grows when voxels are made in another way.
constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kSumBytes = 64;
constexpr std::size_t kVoxelBytes = (3 + 6 + 6 + 3 + 3 + 2) * 4 + 4;

void PutSymmetric(BinaryWriter& writer, const Eigen::Matrix3f& matrix) {
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) writer.Put(matrix(row, column));
  }
}

Eigen::Matrix3f GetSymmetric(BinaryReader& reader) {
  Eigen::Matrix3f matrix;
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) {
      matrix(row, column) = matrix(column, row) = reader.Get<float>();
    }
  }
  return matrix;
}

void Put(BinaryWriter& writer, const NdtVoxel& voxel) {
  writer.Put(voxel.mean);
  PutSymmetric(writer, voxel.information);
  PutSymmetric(writer, voxel.held);
  writer.Put(voxel.normal);
  writer.Put(voxel.facing);
  writer.Put(voxel.thickness_m);
  writer.Put(voxel.flatness);
  writer.Put(voxel.points);
}

NdtVoxel GetVoxel(BinaryReader& reader) {
  NdtVoxel voxel;
  voxel.mean = reader.GetVector();
  voxel.information = GetSymmetric(reader);
  voxel.held = GetSymmetric(reader);
  voxel.normal = reader.GetVector();
  voxel.facing = reader.GetVector();
  voxel.thickness_m = reader.Get<float>();
  voxel.flatness = reader.Get<float>();
  voxel.points = reader.Get<std::uint32_t>();
  return voxel;
}

NdtLevel GetLevel(BinaryReader& reader) {
  const auto resolution_m = reader.Get<double>();
  if (!(resolution_m > 0.0) || !std::isfinite(resolution_m)) reader.Fail("holds no voxel size");
  std::vector<NdtVoxel> voxels(reader.GetSize(kVoxelBytes));
  for (NdtVoxel& voxel : voxels) voxel = GetVoxel(reader);
  return {resolution_m, std::move(voxels)};
}

}  // namespace

std::string SerializeLevels(const std::vector<NdtLevel>& levels, const std::string& key) {
  BinaryWriter writer;
  writer.PutRaw(kMagic, sizeof(kMagic));
  writer.Put(kVersion);
  writer.PutText(key);
  writer.PutSize(levels.size());
  for (const NdtLevel& level : levels) {
    writer.Put(level.resolution_m());
    writer.PutSize(level.voxels().size());
    for (const NdtVoxel& voxel : level.voxels()) Put(writer, voxel);
  }
  const std::string content = writer.Take();
  return content + Sha256(content);
}

std::optional<std::vector<NdtLevel>> ParseLevels(const std::string& bytes, const std::string& key,
                                                 const std::string& source) {
  BinaryReader header(bytes, source);
  if (std::memcmp(header.Advance(sizeof(kMagic)), kMagic, sizeof(kMagic)) != 0) {
    header.Fail("holds no levels");
  }
  if (header.Get<std::uint32_t>() != kVersion || header.GetText() != key) return {};
  if (bytes.size() < kSumBytes) header.Fail("ends too early");
  const std::string content = bytes.substr(0, bytes.size() - kSumBytes);
  if (Sha256(content) != std::string_view(bytes).substr(content.size())) {
    header.Fail("does not agree with its checksum");
  }
  BinaryReader reader(content, source);
  reader.Advance(sizeof(kMagic) + sizeof(kVersion));
  reader.GetText();
  std::vector<NdtLevel> levels;
  const std::size_t count = reader.GetSize(8 + 4);
  for (std::size_t i = 0; i < count; ++i) levels.push_back(GetLevel(reader));
  if (!reader.AtEnd()) reader.Fail("goes on behind its end");
  return levels;
}

std::optional<std::vector<NdtLevel>> ReadLevels(const std::string& path, const std::string& key) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};
  try {
    return ParseLevels(ReadFile(path), key, path);
  } catch (const InputError&) {
    return {};
  }
}

bool WriteLevels(const std::string& path, const std::vector<NdtLevel>& levels,
                 const std::string& key) {
  try {
    WriteFile(path, {SerializeLevels(levels, key)});
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace hv::relocalize
