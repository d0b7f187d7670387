#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace hv::loop {

/// Union-find over 0 ... size - 1. The representative of a set is its smallest element.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parents_(size) {
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
  }

  std::size_t First(std::size_t element) {
    while (parents_[element] != element) {
      parents_[element] = parents_[parents_[element]];
      element = parents_[element];
    }
    return element;
  }

  void Join(std::size_t a, std::size_t b) {
    a = First(a);
    b = First(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parents_;
};

}  // namespace hv::loop
