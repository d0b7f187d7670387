#include "hv_core/one_line.h"

#include <algorithm>

namespace hv {

std::string OneLine(std::string text) {
  constexpr char kDelete = '\x7f';
  const auto is_control = [](char c) { return (c >= 0 && c < ' ') || c == kDelete; };
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}

}  // namespace hv
