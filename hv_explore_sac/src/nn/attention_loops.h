// Included by the two compilations of the inner loops, inside of an anonymous namespace. Loops over
// heads are compiled for kUsualDepth columns a head and for any number (0).

constexpr std::ptrdiff_t kUsualDepth = 16;

template <std::ptrdiff_t kDepth, typename Scalar>
HV_INLINE std::ptrdiff_t DepthOf(const AttentionTask<Scalar>& task) {
  return kDepth > 0 ? kDepth : task.depth;
}

template <typename Scalar>
HV_INLINE Scalar Dot(const Scalar* a, const Scalar* b, std::ptrdiff_t size) {
  using Loose = typename Lanes<Scalar, kVectorBytes>::Loose;
  constexpr std::ptrdiff_t kLanes = Lanes<Scalar, kVectorBytes>::kCount;
  typename Lanes<Scalar, kVectorBytes>::Type lanes = {};
  std::ptrdiff_t i = 0;
  for (; i + kLanes <= size; i += kLanes) {
    lanes += *reinterpret_cast<const Loose*>(a + i) * *reinterpret_cast<const Loose*>(b + i);
  }
  Scalar sum = 0;
  for (; i < size; ++i) sum += a[i] * b[i];
  Scalar even = 0;
  Scalar odd = 0;
  for (std::ptrdiff_t lane = 0; lane < kLanes; lane += 2) {
    even += lanes[lane];
    odd += lanes[lane + 1];
  }
  return sum + (even + odd);
}

/// y += factor x
template <typename Scalar>
HV_INLINE void AddScaled(Scalar factor, const Scalar* x, Scalar* y, std::ptrdiff_t size) {
  using Loose = typename Lanes<Scalar, kVectorBytes>::Loose;
  constexpr std::ptrdiff_t kLanes = Lanes<Scalar, kVectorBytes>::kCount;
  std::ptrdiff_t i = 0;
  for (; i + kLanes <= size; i += kLanes) {
    *reinterpret_cast<Loose*>(y + i) += factor * *reinterpret_cast<const Loose*>(x + i);
  }
  for (; i < size; ++i) y[i] += factor * x[i];
}

template <std::ptrdiff_t kDepth, typename Scalar>
void ScoresOfHeads(const AttentionTask<Scalar>& task, Scalar* scores) {
  const std::ptrdiff_t depth = DepthOf<kDepth>(task);
  const std::ptrdiff_t width = task.heads * depth;
  for (std::ptrdiff_t i = 0; i < task.rows; ++i) {
    const Scalar* const q = task.q + i * width;
    for (std::ptrdiff_t e = task.start[i]; e < task.start[i + 1]; ++e) {
      const Scalar* const key = task.kv + task.neighbour[e] * 2 * width;
      for (std::ptrdiff_t h = 0; h < task.heads; ++h) {
        scores[e * task.heads + h] += task.scale * Dot(q + h * depth, key + h * depth, depth);
      }
    }
  }
}

template <std::ptrdiff_t kDepth, typename Scalar>
void MixOfHeads(const AttentionTask<Scalar>& task, const Scalar* weights, Scalar* out) {
  const std::ptrdiff_t depth = DepthOf<kDepth>(task);
  const std::ptrdiff_t width = task.heads * depth;
  for (std::ptrdiff_t i = 0; i < task.rows; ++i) {
    Scalar* const mixed = out + i * width;
    std::memset(mixed, 0, static_cast<std::size_t>(width) * sizeof(Scalar));
    for (std::ptrdiff_t e = task.start[i]; e < task.start[i + 1]; ++e) {
      const Scalar* const value = task.kv + (task.neighbour[e] * 2 + 1) * width;
      for (std::ptrdiff_t h = 0; h < task.heads; ++h) {
        AddScaled(weights[e * task.heads + h], value + h * depth, mixed + h * depth, depth);
      }
    }
  }
}

/// Backward through mixing and softmax at once: d_score = w (d_w - sum_e w d_w), and that sum is
/// <d_out, out>, so each edge is visited once.
template <std::ptrdiff_t kDepth, typename Scalar>
void BackwardOfHeads(const AttentionTask<Scalar>& task, const AttentionGradient<Scalar>& gradient) {
  const std::ptrdiff_t depth = DepthOf<kDepth>(task);
  const std::ptrdiff_t width = task.heads * depth;
  for (std::ptrdiff_t i = 0; i < task.rows; ++i) {
    for (std::ptrdiff_t h = 0; h < task.heads; ++h) {
      const std::ptrdiff_t at = i * width + h * depth;
      const Scalar* const d_out = gradient.d_out + at;
      const Scalar mean = Dot(d_out, gradient.out + at, depth);
      for (std::ptrdiff_t e = task.start[i]; e < task.start[i + 1]; ++e) {
        const std::ptrdiff_t key = task.neighbour[e] * 2 * width + h * depth;
        const std::ptrdiff_t value = key + width;
        Scalar& weight = gradient.weights[e * task.heads + h];
        AddScaled(weight, d_out, gradient.d_kv + value, depth);
        weight *= Dot(d_out, task.kv + value, depth) - mean;
        AddScaled(task.scale * weight, task.kv + key, gradient.d_q + at, depth);
        AddScaled(task.scale * weight, task.q + at, gradient.d_kv + key, depth);
      }
    }
  }
}

/// exp(x) for x <= 0, to about two units in the last place: 2^n exp(r) with |r| <= ln(2) / 2.
HV_INLINE float Exp(float x) {
  constexpr float kRound = 12582912.0F;  // adding it leaves the nearest whole number
  x = x < -87.0F ? -87.0F : x;
  const float shifted = x * 1.44269504F + kRound;
  const float n = shifted - kRound;
  const float r = (x - n * 0.693359375F) + n * 2.12194440e-4F;
  float series = 1.9875691500e-4F;
  series = series * r + 1.3981999507e-3F;
  series = series * r + 8.3334519073e-3F;
  series = series * r + 4.1665795894e-2F;
  series = series * r + 1.6666665459e-1F;
  series = series * r + 5.0000001201e-1F;
  const float fraction = series * r * r + r + 1.0F;
  std::int32_t bits;
  std::memcpy(&bits, &shifted, sizeof(bits));
  bits = static_cast<std::int32_t>((static_cast<std::uint32_t>(bits) << 23U) + 0x3f800000U);
  float power;
  std::memcpy(&power, &bits, sizeof(power));
  return fraction * power;
}
HV_INLINE double Exp(double x) { return __builtin_exp(x); }

/// Takes the largest score of each of kHeads heads, from `head` on, off the scores of a query.
template <int kHeads, typename Scalar>
HV_INLINE void TakeOffLargest(const AttentionTask<Scalar>& task, std::ptrdiff_t i,
                              std::ptrdiff_t head, Scalar* scores) {
  Scalar* const first = scores + task.start[i] * task.heads + head;
  Scalar* const last = scores + task.start[i + 1] * task.heads + head;
  Scalar largest[kHeads];
  for (int h = 0; h < kHeads; ++h) largest[h] = first[h];
  for (const Scalar* score = first; score < last; score += task.heads) {
    for (int h = 0; h < kHeads; ++h) largest[h] = score[h] > largest[h] ? score[h] : largest[h];
  }
  for (Scalar* score = first; score < last; score += task.heads) {
    for (int h = 0; h < kHeads; ++h) score[h] -= largest[h];
  }
}

/// Divides by the sum of each of kHeads heads.
template <int kHeads, typename Scalar>
HV_INLINE void DivideBySum(const AttentionTask<Scalar>& task, std::ptrdiff_t i, std::ptrdiff_t head,
                           Scalar* scores) {
  Scalar* const first = scores + task.start[i] * task.heads + head;
  Scalar* const last = scores + task.start[i + 1] * task.heads + head;
  Scalar factor[kHeads] = {};
  for (const Scalar* score = first; score < last; score += task.heads) {
    for (int h = 0; h < kHeads; ++h) factor[h] += score[h];
  }
  for (int h = 0; h < kHeads; ++h) factor[h] = 1 / factor[h];
  for (Scalar* score = first; score < last; score += task.heads) {
    for (int h = 0; h < kHeads; ++h) score[h] *= factor[h];
  }
}

/// Softmax over the neighbours of each query, head by head, in place.
template <typename Scalar>
void SoftmaxLoop(const AttentionTask<Scalar>& task, Scalar* scores) {
  constexpr int kGroup = 4;
  for (std::ptrdiff_t i = 0; i < task.rows; ++i) {
    std::ptrdiff_t head = 0;
    for (; head + kGroup <= task.heads; head += kGroup)
      TakeOffLargest<kGroup>(task, i, head, scores);
    for (; head < task.heads; ++head) TakeOffLargest<1>(task, i, head, scores);
  }
  const std::ptrdiff_t count = task.start[task.rows] * task.heads;
  for (std::ptrdiff_t e = 0; e < count; ++e) scores[e] = Exp(scores[e]);
  for (std::ptrdiff_t i = 0; i < task.rows; ++i) {
    std::ptrdiff_t head = 0;
    for (; head + kGroup <= task.heads; head += kGroup) DivideBySum<kGroup>(task, i, head, scores);
    for (; head < task.heads; ++head) DivideBySum<1>(task, i, head, scores);
  }
}

template <typename Scalar>
void ScoresLoop(const AttentionTask<Scalar>& task, Scalar* scores) {
  if (task.depth == kUsualDepth) return ScoresOfHeads<kUsualDepth>(task, scores);
  ScoresOfHeads<0>(task, scores);
}

template <typename Scalar>
void MixLoop(const AttentionTask<Scalar>& task, const Scalar* weights, Scalar* out) {
  if (task.depth == kUsualDepth) return MixOfHeads<kUsualDepth>(task, weights, out);
  MixOfHeads<0>(task, weights, out);
}

template <typename Scalar>
void BackwardLoop(const AttentionTask<Scalar>& task, const AttentionGradient<Scalar>& gradient) {
  if (task.depth == kUsualDepth) return BackwardOfHeads<kUsualDepth>(task, gradient);
  BackwardOfHeads<0>(task, gradient);
}
