// Included by the two compilations of the inner loops, inside of an anonymous namespace. Loops over
// heads are compiled for kUsualDepth columns a head and for any number (0).

constexpr std::ptrdiff_t kUsualDepth = 16;

template <std::ptrdiff_t kDepth, typename Scalar>
HV_INLINE std::ptrdiff_t DepthOf(const AttentionTask<Scalar>& task) {
  return kDepth > 0 ? kDepth : task.depth;
}

template <typename Scalar>
HV_INLINE Scalar Dot(const Scalar* a, const Scalar* b, std::ptrdiff_t size) {
  using Loose = typename Lanes<Scalar>::Loose;
  constexpr std::ptrdiff_t kLanes = Lanes<Scalar>::kCount;
  typename Lanes<Scalar>::Type lanes = {};
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
  using Loose = typename Lanes<Scalar>::Loose;
  constexpr std::ptrdiff_t kLanes = Lanes<Scalar>::kCount;
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

/// Gradient of the scores of one query from that of its mixed values: through the mixing, then
/// through the softmax, d_score = w (d_w - sum_e w d_w).
template <std::ptrdiff_t kDepth, typename Scalar>
HV_INLINE void ScoreGradient(const AttentionTask<Scalar>& task, std::ptrdiff_t i,
                             std::ptrdiff_t h, const Scalar* d_mixed, Scalar* weights,
                             Scalar* d_kv) {
  const std::ptrdiff_t depth = DepthOf<kDepth>(task);
  const std::ptrdiff_t width = task.heads * depth;
  constexpr std::ptrdiff_t kBuffer = 64;
  Scalar buffer[kBuffer];
  Scalar mean = 0;
  const std::ptrdiff_t first = task.start[i];
  const std::ptrdiff_t last = task.start[i + 1];
  for (std::ptrdiff_t e = first; e < last; ++e) {
    const std::ptrdiff_t value = (task.neighbour[e] * 2 + 1) * width + h * depth;
    const Scalar weight = weights[e * task.heads + h];
    const Scalar d_weight = Dot(d_mixed, task.kv + value, depth);
    if (e - first < kBuffer) buffer[e - first] = d_weight;
    mean += weight * d_weight;
    AddScaled(weight, d_mixed, d_kv + value, depth);
  }
  for (std::ptrdiff_t e = first; e < last; ++e) {
    const std::ptrdiff_t value = (task.neighbour[e] * 2 + 1) * width + h * depth;
    const Scalar d_weight =
        e - first < kBuffer ? buffer[e - first] : Dot(d_mixed, task.kv + value, depth);
    weights[e * task.heads + h] *= d_weight - mean;
  }
}

template <std::ptrdiff_t kDepth, typename Scalar>
void BackwardOfHeads(const AttentionTask<Scalar>& task, const Scalar* d_out, Scalar* weights,
                     Scalar* d_q, Scalar* d_kv) {
  const std::ptrdiff_t depth = DepthOf<kDepth>(task);
  const std::ptrdiff_t width = task.heads * depth;
  for (std::ptrdiff_t i = 0; i < task.rows; ++i) {
    for (std::ptrdiff_t h = 0; h < task.heads; ++h) {
      const std::ptrdiff_t at = i * width + h * depth;
      ScoreGradient<kDepth>(task, i, h, d_out + at, weights, d_kv);
      for (std::ptrdiff_t e = task.start[i]; e < task.start[i + 1]; ++e) {
        const std::ptrdiff_t key = task.neighbour[e] * 2 * width + h * depth;
        const Scalar d_score = task.scale * weights[e * task.heads + h];
        AddScaled(d_score, task.kv + key, d_q + at, depth);
        AddScaled(d_score, task.q + at, d_kv + key, depth);
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

/// Softmax over the neighbours of each query, head by head, in place.
template <typename Scalar>
void SoftmaxLoop(const AttentionTask<Scalar>& task, Scalar* scores) {
  const std::ptrdiff_t heads = task.heads;
  for (std::ptrdiff_t i = 0; i < task.rows; ++i) {
    for (std::ptrdiff_t h = 0; h < heads; ++h) {
      const std::ptrdiff_t first = task.start[i] * heads + h;
      const std::ptrdiff_t last = task.start[i + 1] * heads + h;
      Scalar largest = scores[first];
      for (std::ptrdiff_t e = first; e < last; e += heads) {
        largest = scores[e] > largest ? scores[e] : largest;
      }
      for (std::ptrdiff_t e = first; e < last; e += heads) scores[e] -= largest;
    }
  }
  const std::ptrdiff_t count = task.start[task.rows] * heads;
  for (std::ptrdiff_t e = 0; e < count; ++e) scores[e] = Exp(scores[e]);
  for (std::ptrdiff_t i = 0; i < task.rows; ++i) {
    for (std::ptrdiff_t h = 0; h < heads; ++h) {
      const std::ptrdiff_t first = task.start[i] * heads + h;
      const std::ptrdiff_t last = task.start[i + 1] * heads + h;
      Scalar sum = 0;
      for (std::ptrdiff_t e = first; e < last; e += heads) sum += scores[e];
      const Scalar inverse = 1 / sum;
      for (std::ptrdiff_t e = first; e < last; e += heads) scores[e] *= inverse;
    }
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
void BackwardLoop(const AttentionTask<Scalar>& task, const Scalar* d_out, Scalar* weights,
                  Scalar* d_q, Scalar* d_kv) {
  if (task.depth == kUsualDepth) {
    return BackwardOfHeads<kUsualDepth>(task, d_out, weights, d_q, d_kv);
  }
  BackwardOfHeads<0>(task, d_out, weights, d_q, d_kv);
}
