#pragma once

#include <functional>
#include <memory>

namespace hv::lio {

/// A fixed number of threads that TBB loops inside Execute may use, whatever the rest of the
/// process does.
class ThreadArena {
 public:
  explicit ThreadArena(int threads);
  ~ThreadArena();
  void Execute(const std::function<void()>& work);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hv::lio
