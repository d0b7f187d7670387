#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

#include <Eigen/Core>

#include "hv_core/error.h"

namespace hv {

/// Puts numbers into a string of bytes, little endian.
class BinaryWriter {
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

/// Takes numbers out of bytes again. Whatever the bytes are, it ends in an InputError that names
/// `source`, never outside of them. Keeps references to both.
class BinaryReader {
 public:
  BinaryReader(const std::string& bytes, const std::string& source)
      : bytes_(bytes), source_(source) {}

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

}  // namespace hv
