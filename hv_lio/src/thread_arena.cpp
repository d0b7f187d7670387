#include "hv_lio/thread_arena.h"

#include <tbb/task_arena.h>

namespace hv::lio {

struct ThreadArena::Impl {
  explicit Impl(int threads) : arena(threads) {}
  tbb::task_arena arena;
};

ThreadArena::ThreadArena(int threads) : impl_(std::make_unique<Impl>(threads)) {}

ThreadArena::~ThreadArena() = default;

void ThreadArena::Execute(const std::function<void()>& work) { impl_->arena.execute(work); }

}  // namespace hv::lio
