// Included by the two compilations of the inner loops, inside of an anonymous namespace.

#define HV_INLINE inline __attribute__((always_inline))

#ifdef __AVX__
constexpr int kVectorBytes = 32;
#else
constexpr int kVectorBytes = 16;
#endif

/// The numbers of one vector register, and the same lying anywhere in memory.
template <typename Scalar, int kBytes>
struct Lanes {
  typedef Scalar Type __attribute__((vector_size(kBytes)));
  typedef Scalar Loose __attribute__((vector_size(kBytes), aligned(sizeof(Scalar)), may_alias));
  static constexpr std::ptrdiff_t kCount = kBytes / sizeof(Scalar);
};

/// Rows of a tile: with two vectors a row, its 12 sums fill the 16 vector registers best.
constexpr int kTileRows = 6;

/// One tile of c, held in registers over the whole depth.
template <typename Scalar, int kBytes, int kRows, int kVectors>
HV_INLINE void AddTile(const ProductTask<Scalar>& task, std::ptrdiff_t row, std::ptrdiff_t col) {
  using Loose = typename Lanes<Scalar, kBytes>::Loose;
  constexpr std::ptrdiff_t kLanes = Lanes<Scalar, kBytes>::kCount;
  using Vec = typename Lanes<Scalar, kBytes>::Type;
  Vec sum[kRows][kVectors] = {};
  const Scalar* a = task.a + row * task.a_row;
  const Scalar* b = task.b + col;
  for (std::ptrdiff_t k = 0; k < task.depth; ++k, a += task.a_depth, b += task.cols) {
    const Vec first = *reinterpret_cast<const Loose*>(b);
    const Vec last = *reinterpret_cast<const Loose*>(b + (kVectors - 1) * kLanes);
#pragma GCC unroll 8
    for (int r = 0; r < kRows; ++r) {
      const Scalar left = a[r * task.a_row];
      sum[r][0] += left * first;
      if (kVectors == 2) sum[r][kVectors - 1] += left * last;
    }
  }
  for (int r = 0; r < kRows; ++r) {
    for (int v = 0; v < kVectors; ++v) {
      Scalar* const c = task.c + (row + r) * task.cols + col + v * kLanes;
      *reinterpret_cast<Loose*>(c) += sum[r][v];
    }
  }
}

template <typename Scalar, int kBytes, int kVectors>
void AddColumns(const ProductTask<Scalar>& task, std::ptrdiff_t col) {
  std::ptrdiff_t row = 0;
  for (; row + kTileRows <= task.rows; row += kTileRows) {
    AddTile<Scalar, kBytes, kTileRows, kVectors>(task, row, col);
  }
  for (; row + 2 <= task.rows; row += 2) AddTile<Scalar, kBytes, 2, kVectors>(task, row, col);
  if (row < task.rows) AddTile<Scalar, kBytes, 1, kVectors>(task, row, col);
}

/// The last columns, fewer than fill a vector.
template <typename Scalar>
void AddRest(const ProductTask<Scalar>& task, std::ptrdiff_t col) {
  for (std::ptrdiff_t row = 0; row < task.rows; ++row) {
    Scalar* const c = task.c + row * task.cols;
    for (std::ptrdiff_t k = 0; k < task.depth; ++k) {
      const Scalar left = task.a[row * task.a_row + k * task.a_depth];
      const Scalar* const b = task.b + k * task.cols;
      for (std::ptrdiff_t j = col; j < task.cols; ++j) c[j] += left * b[j];
    }
  }
}

template <typename Scalar>
void AddProductLoop(const ProductTask<Scalar>& task) {
  constexpr std::ptrdiff_t kWide = Lanes<Scalar, kVectorBytes>::kCount;
  constexpr std::ptrdiff_t kNarrow = Lanes<Scalar, 16>::kCount;
  std::ptrdiff_t col = 0;
  for (; col + 2 * kWide <= task.cols; col += 2 * kWide) {
    AddColumns<Scalar, kVectorBytes, 2>(task, col);
  }
  for (; col + kWide <= task.cols; col += kWide) AddColumns<Scalar, kVectorBytes, 1>(task, col);
  for (; col + kNarrow <= task.cols; col += kNarrow) AddColumns<Scalar, 16, 1>(task, col);
  if (col < task.cols) AddRest(task, col);
}
