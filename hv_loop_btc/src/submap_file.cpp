#include "hv_loop_btc/submap_file.h"

#include <cmath>
#include <cstring>
#include <type_traits>

#include "hv_core/error.h"

namespace hv::loop {
namespace {

constexpr char kMagic[8] = {'H', 'V', 'B', 'T', 'C', 'D', 'E', 'S'};
constexpr std::uint32_t kVersion = 1;

class Writer {
 public:
  template <typename Value>
  void Put(const Value& value) {
    static_assert(std::is_arithmetic_v<Value>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(Value));
  }
  void PutSize(std::size_t size) { Put(static_cast<std::uint32_t>(size)); }
  void Put(const Eigen::Vector3f& vector) {
    for (int i = 0; i < 3; ++i) Put(vector[i]);
  }
  void PutText(const std::string& text) {
    PutSize(text.size());
    bytes_ += text;
  }
  void PutRaw(const char* bytes, std::size_t size) { bytes_.append(bytes, size); }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  Reader(const std::string& bytes, const std::string& source) : bytes_(bytes), source_(source) {}

  template <typename Value>
  Value Get() {
    static_assert(std::is_arithmetic_v<Value>);
    Value value;
    std::memcpy(&value, Advance(sizeof(Value)), sizeof(Value));
    return value;
  }
  /// A count of items of at least `item_bytes` each: refused when they cannot all be there.
  std::size_t GetSize(std::size_t item_bytes) {
    const std::size_t size = Get<std::uint32_t>();
    if (size * item_bytes > bytes_.size() - at_) Fail("ends too early");
    return size;
  }
  Eigen::Vector3f GetVector() {
    Eigen::Vector3f vector;
    for (int i = 0; i < 3; ++i) vector[i] = Get<float>();
    if (!vector.allFinite()) Fail("holds a number that is not finite");
    return vector;
  }
  std::string GetText() {
    const std::size_t size = GetSize(1);
    return std::string(Advance(size), size);
  }
  const char* Advance(std::size_t size) {
    if (size > bytes_.size() - at_) Fail("ends too early");
    const char* here = bytes_.data() + at_;
    at_ += size;
    return here;
  }
  bool AtEnd() const { return at_ == bytes_.size(); }
  [[noreturn]] void Fail(const std::string& what) const { throw InputError(source_ + ": " + what); }

 private:
  const std::string& bytes_;
  const std::string& source_;
  std::size_t at_ = 0;
};

void Put(Writer& writer, const SubmapRecord& record) {
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

SubmapRecord GetRecord(Reader& reader) {
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

void Put(Writer& writer, const BtcDescriptor& descriptor) {
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

BtcDescriptor GetDescriptor(Reader& reader) {
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
  Writer writer;
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
  Reader reader(bytes, source);
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
