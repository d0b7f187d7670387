#include "hv_loop_btc/submap_file.h"

#include <cmath>
#include <cstring>

#include "hv_core/binary_io.h"

namespace hv::loop {
namespace {

constexpr char kMagic[8] = {'H', 'V', 'B', 'T', 'C', 'D', 'E', 'S'};
constexpr std::uint32_t kVersion = 1;

void Put(BinaryWriter& writer, const SubmapRecord& record) {
  writer.Put(record.keyframe);
  writer.Put(record.stamp.nanoseconds());
  writer.Put(record.travelled_m);
  writer.PutSize(record.members.size());
  for (const SubmapMember& member : record.members) {
    writer.Put(member.keyframe);
    const Eigen::Quaterniond q(member.T_submap_keyframe.linear());
    const Eigen::Vector3d t = member.T_submap_keyframe.translation();
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) writer.Put(value);
  }
}

SubmapRecord GetRecord(BinaryReader& reader) {
  constexpr std::size_t kMemberBytes = 4 + 7 * 8;
  SubmapRecord record;
  record.keyframe = reader.Get<std::uint32_t>();
  record.stamp = Time::FromNanoseconds(reader.Get<std::int64_t>());
  record.travelled_m = reader.Get<double>();
  record.members.resize(reader.GetSize(kMemberBytes));
  for (SubmapMember& member : record.members) {
    member.keyframe = reader.Get<std::uint32_t>();
    double v[7];
    for (double& value : v) value = reader.Get<double>();
    const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    const Eigen::Vector3d t(v[0], v[1], v[2]);
    if (!t.allFinite() || !(std::abs(q.norm() - 1.0) < 1e-6)) reader.Fail("holds a broken pose");
    member.T_submap_keyframe = MakePose(q, t);
  }
  return record;
}

void Put(BinaryWriter& writer, const BtcDescriptor& descriptor) {
  writer.Put(descriptor.keyframe);
  writer.PutSize(descriptor.keypoints.size());
  for (const BtcKeypoint& keypoint : descriptor.keypoints) {
    writer.Put(keypoint.position);
    writer.Put(keypoint.bits);
  }
  writer.PutSize(descriptor.triangles.size());
  for (const BtcTriangle& triangle : descriptor.triangles) {
    for (const std::uint16_t vertex : triangle.vertices) writer.Put(vertex);
  }
  writer.PutSize(descriptor.planes.size());
  for (const PlaneVoxel& plane : descriptor.planes) {
    writer.Put(plane.center);
    writer.Put(plane.normal);
    writer.Put(plane.points);
  }
}

BtcDescriptor GetDescriptor(BinaryReader& reader) {
  BtcDescriptor descriptor;
  descriptor.keyframe = reader.Get<std::uint32_t>();
  descriptor.keypoints.resize(reader.GetSize(3 * 4 + 8));
  for (BtcKeypoint& keypoint : descriptor.keypoints) {
    keypoint.position = reader.GetVector();
    keypoint.bits = reader.Get<std::uint64_t>();
  }
  descriptor.triangles.resize(reader.GetSize(3 * 2));
  for (BtcTriangle& triangle : descriptor.triangles) {
    for (std::uint16_t& vertex : triangle.vertices) {
      vertex = reader.Get<std::uint16_t>();
      if (vertex >= descriptor.keypoints.size()) reader.Fail("holds a triangle without corners");
    }
  }
  descriptor.planes.resize(reader.GetSize(7 * 4));
  for (PlaneVoxel& plane : descriptor.planes) {
    plane.center = reader.GetVector();
    plane.normal = reader.GetVector();
    plane.points = reader.Get<float>();
  }
  return descriptor;
}

}  // namespace

std::string Serialize(const StoredSubmaps& submaps) {
  BinaryWriter writer;
  writer.PutRaw(kMagic, sizeof(kMagic));
  writer.Put(kVersion);
  writer.PutText(submaps.scale);
  writer.PutSize(submaps.records.size());
  for (std::size_t i = 0; i < submaps.records.size(); ++i) {
    Put(writer, submaps.records[i]);
    Put(writer, submaps.descriptors[i]);
  }
  return writer.Take();
}

StoredSubmaps ParseSubmaps(const std::string& bytes, const std::string& source) {
  BinaryReader reader(bytes, source);
  if (std::memcmp(reader.Advance(sizeof(kMagic)), kMagic, sizeof(kMagic)) != 0) {
    reader.Fail("holds no descriptors");
  }
  const auto version = reader.Get<std::uint32_t>();
  if (version != kVersion) {
    reader.Fail("version " + std::to_string(version) + " of descriptors is not known");
  }
  StoredSubmaps submaps;
  submaps.scale = reader.GetText();
  if (submaps.scale != "indoor" && submaps.scale != "outdoor" && submaps.scale != "auto") {
    reader.Fail("holds no known scale");
  }
  const std::size_t count = reader.GetSize(4 + 8 + 8 + 4 + 4 + 4 + 4 + 4);
  for (std::size_t i = 0; i < count; ++i) {
    submaps.records.push_back(GetRecord(reader));
    submaps.descriptors.push_back(GetDescriptor(reader));
  }
  if (!reader.AtEnd()) reader.Fail("goes on behind its end");
  return submaps;
}

}  // namespace hv::loop
