#include "hv_explore_sac/nn/batch.h"

#include <algorithm>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace hv::explore::nn {
namespace {

/// Bounds the memory of the sums and the threads that can help.
constexpr std::size_t kChunks = 16;

}  // namespace

Eigen::VectorXf BatchSum::Run(std::size_t count,
                              const std::function<void(std::size_t, float*)>& add) {
  const std::size_t chunks = std::min(kChunks, count);
  if (sums_.size() < chunks) sums_.resize(chunks);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunks, 1), [&](const auto& range) {
    for (std::size_t chunk = range.begin(); chunk != range.end(); ++chunk) {
      Eigen::VectorXf& sum = sums_[chunk];
      sum.setZero(size_);
      const std::size_t last = (chunk + 1) * count / chunks;
      for (std::size_t i = chunk * count / chunks; i < last; ++i) add(i, sum.data());
    }
  });
  Eigen::VectorXf total = Eigen::VectorXf::Zero(size_);
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) total += sums_[chunk];
  return total;
}

}  // namespace hv::explore::nn
