#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace hv::explore::nn {

/// Things that threads borrow, workspaces above all; as many are made as are in use at once.
/// Thread-safe.
template <typename Thing>
class Pool {
 public:
  /// A loan that ends with its life.
  class Loan {
   public:
    explicit Loan(Pool& pool) : pool_(pool), thing_(pool.Take()) {}
    ~Loan() { pool_.Give(std::move(thing_)); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    Thing& operator*() const { return *thing_; }
    Thing* operator->() const { return thing_.get(); }

   private:
    Pool& pool_;
    std::unique_ptr<Thing> thing_;
  };

 private:
  std::unique_ptr<Thing> Take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (free_.empty()) return std::make_unique<Thing>();
    std::unique_ptr<Thing> thing = std::move(free_.back());
    free_.pop_back();
    return thing;
  }
  void Give(std::unique_ptr<Thing> thing) {
    const std::lock_guard<std::mutex> lock(mutex_);
    free_.push_back(std::move(thing));
  }

  std::mutex mutex_;
  /// Guarded by mutex_.
  std::vector<std::unique_ptr<Thing>> free_;
};

/// Sums over the samples of a batch, made by several threads and yet the same for any number of
/// them: consecutive samples form chunks, each chunk sums for itself, and chunks are added in
/// order.
class BatchSum {
 public:
  explicit BatchSum(Eigen::Index size) : size_(size) {}

  /// Calls `add(sample, sum)` for each sample below `count`, from several threads, in order within
  /// a chunk; `add` adds to the `size` numbers at `sum`. Gives the total.
  Eigen::VectorXf Run(std::size_t count,
                      const std::function<void(std::size_t sample, float* sum)>& add);

 private:
  Eigen::Index size_;
  /// Kept from batch to batch.
  std::vector<Eigen::VectorXf> sums_;
};

}  // namespace hv::explore::nn
