#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

namespace hv::explore::nn {

using Eigen::Index;

template <typename Scalar>
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
template <typename Scalar>
using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

/// A row-major matrix without gaps in memory that someone else owns; one row per node. Cheap to
/// copy. `View<const Scalar>` promises not to write.
template <typename Scalar>
struct View {
  using Value = std::remove_const_t<Scalar>;
  using Dense = std::conditional_t<std::is_const_v<Scalar>, const Matrix<Value>, Matrix<Value>>;

  View() = default;
  View(Scalar* memory, Index row_count, Index column_count)
      : data(memory), rows(row_count), cols(column_count) {}
  /// Reading is allowed wherever writing is.
  template <typename Other, typename = std::enable_if_t<std::is_same_v<const Other, Scalar> &&
                                                        !std::is_const_v<Other>>>
  View(const View<Other>& other) : data(other.data), rows(other.rows), cols(other.cols) {}

  Eigen::Map<Dense> matrix() const { return Eigen::Map<Dense>(data, rows, cols); }
  Scalar* row(Index i) const { return data + i * cols; }
  Index size() const { return rows * cols; }

  Scalar* data = nullptr;
  Index rows = 0;
  Index cols = 0;
};

/// Memory for the activations of one sample: views are taken one after the other and all given
/// back at once. Keeps what it ever took from the system, so that a pass no longer allocates once
/// the largest sample has been seen. Not thread-safe: one arena per thread.
template <typename Scalar>
class Arena {
  /// Where the next view will be taken from.
  struct Top {
    std::size_t block = 0;
    std::size_t used = 0;
  };

 public:
  /// Not initialised, aligned to a cache line. Valid until Reset() or the end of the Scope in
  /// which it was taken.
  View<Scalar> Take(Index rows, Index cols) { return {Allocate(rows * cols), rows, cols}; }
  View<Scalar> TakeZero(Index rows, Index cols) {
    const View<Scalar> view = Take(rows, cols);
    view.matrix().setZero();
    return view;
  }
  void Reset() { top_ = {}; }
  /// Blocks taken from the system so far.
  std::size_t allocations() const { return blocks_.size(); }

  /// Gives back what was taken during its life.
  class Scope {
   public:
    explicit Scope(Arena& arena) : arena_(arena), top_(arena.top_) {}
    ~Scope() { arena_.top_ = top_; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Arena& arena_;
    const Top top_;
  };

 private:
  static constexpr std::size_t kLine = 64;
  static constexpr std::size_t kBlock = std::size_t{1} << 20U;

  struct Free {
    void operator()(Scalar* memory) const { std::free(memory); }
  };
  struct Block {
    std::unique_ptr<Scalar, Free> memory;
    std::size_t size = 0;
  };

  Scalar* Allocate(Index count) {
    constexpr std::size_t kStep = kLine / sizeof(Scalar);
    const std::size_t size = (static_cast<std::size_t>(count) + kStep - 1) / kStep * kStep;
    while (top_.block < blocks_.size() && top_.used + size > blocks_[top_.block].size) {
      top_ = {top_.block + 1, 0};
    }
    if (top_.block == blocks_.size()) AddBlock(std::max(size, kBlock));
    Scalar* memory = blocks_[top_.block].memory.get() + top_.used;
    top_.used += size;
    return memory;
  }

  void AddBlock(std::size_t size) {
    auto* memory = static_cast<Scalar*>(std::aligned_alloc(kLine, size * sizeof(Scalar)));
    if (memory == nullptr) throw std::bad_alloc();
    blocks_.push_back({std::unique_ptr<Scalar, Free>(memory), size});
  }

  std::vector<Block> blocks_;
  Top top_;
};

}  // namespace hv::explore::nn
