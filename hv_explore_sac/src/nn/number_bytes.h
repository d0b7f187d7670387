#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "hv_core/error.h"

namespace hv::explore::nn {

/// Numbers one after the other in a string of bytes, in the order of bytes of this machine.
template <typename Number>
void AppendNumber(Number number, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

/// Their count, then the numbers.
template <typename Number>
void AppendNumbers(const std::vector<Number>& numbers, std::string& bytes) {
  AppendNumber(static_cast<std::uint64_t>(numbers.size()), bytes);
  if (numbers.empty()) return;
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
}

/// Takes a number off the front. Throws InputError when there are not enough bytes.
template <typename Number>
void TakeNumber(std::string_view& bytes, Number& number) {
  if (bytes.size() < sizeof(number)) throw InputError("packed numbers end too early");
  std::memcpy(&number, bytes.data(), sizeof(number));
  bytes.remove_prefix(sizeof(number));
}

template <typename Number>
void TakeNumbers(std::string_view& bytes, std::vector<Number>& numbers) {
  std::uint64_t count = 0;
  TakeNumber(bytes, count);
  if (count > bytes.size() / sizeof(Number)) throw InputError("packed numbers end too early");
  numbers.resize(static_cast<std::size_t>(count));
  if (numbers.empty()) return;
  std::memcpy(static_cast<void*>(numbers.data()), bytes.data(), numbers.size() * sizeof(Number));
  bytes.remove_prefix(numbers.size() * sizeof(Number));
}

}  // namespace hv::explore::nn
