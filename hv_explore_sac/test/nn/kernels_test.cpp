#include "hv_explore_sac/nn/kernels.h"

#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kernel_table.h"
#include "sample_graphs.h"

namespace hv::explore::nn {
namespace {

template <typename Scalar>
class Products : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Products, Scalars);

/// Every remainder of rows and columns within a tile.
TYPED_TEST(Products, EqualThoseOfEigen) {
  using Scalar = TypeParam;
  std::mt19937 random(1);
  const double tolerance = 100.0 * static_cast<double>(Eigen::NumTraits<Scalar>::epsilon());
  for (Index rows = 1; rows <= 13; ++rows) {
    for (Index cols = 1; cols <= 37; ++cols) {
      const Index depth = 1 + (rows * cols) % 9;
      const Matrix<Scalar> a = RandomMatrix(random, rows, depth).cast<Scalar>();
      const Matrix<Scalar> b = RandomMatrix(random, depth, cols).cast<Scalar>();
      Matrix<Scalar> c = RandomMatrix(random, rows, cols).cast<Scalar>();
      const Matrix<Scalar> expected = c + a * b;
      AddProduct<Scalar>({a.data(), rows, depth}, {b.data(), depth, cols}, {c.data(), rows, cols});
      EXPECT_LT(static_cast<double>((c - expected).cwiseAbs().maxCoeff()), tolerance);
      Matrix<Scalar> d = Matrix<Scalar>::Zero(depth, cols);
      AddTransposedProduct<Scalar>({a.data(), rows, depth}, {c.data(), rows, cols},
                                   {d.data(), depth, cols});
      EXPECT_LT(static_cast<double>((d - a.transpose() * c).cwiseAbs().maxCoeff()), tolerance);
    }
  }
}

/// Attention as textbooks write it, with a mask of all pairs.
Matrix<double> DenseAttention(const GraphLevel& level, const Matrix<double>& q,
                              const Matrix<double>& kv, Index heads) {
  const Index nodes = level.nodes();
  const Index width = q.cols();
  const Index depth = width / heads;
  Matrix<double> out(nodes, width);
  for (Index h = 0; h < heads; ++h) {
    Matrix<double> weights = Matrix<double>::Zero(nodes, nodes);
    for (Index i = 0; i < nodes; ++i) {
      for (std::int32_t e = level.start[static_cast<std::size_t>(i)];
           e < level.start[static_cast<std::size_t>(i) + 1]; ++e) {
        const Index j = level.neighbour[static_cast<std::size_t>(e)];
        weights(i, j) =
            std::exp(q.row(i).segment(h * depth, depth).dot(kv.row(j).segment(h * depth, depth)) /
                     std::sqrt(static_cast<double>(depth)));
      }
      weights.row(i) /= weights.row(i).sum();
    }
    out.middleCols(h * depth, depth) = weights * kv.middleCols(width + h * depth, depth);
  }
  return out;
}

/// Widths that take the loops for usual heads, for few columns, and for odd numbers of heads.
TEST(Attention, EqualsDenseAttentionUnderAMask) {
  const GraphSample sample = BuildSample(RandomGraph(3, 60, 2), 0);
  const GraphLevel& level = sample.levels[0];
  std::mt19937 random(2);
  for (const auto& [width, heads] :
       std::vector<std::pair<Index, Index>>{{64, 4}, {12, 3}, {6, 6}, {80, 5}}) {
    const Matrix<float> q = RandomMatrix(random, 60, width);
    const Matrix<float> kv = RandomMatrix(random, 60, 2 * width);
    const NeighbourLists lists{60, level.start.data(), level.neighbour.data()};
    const AttentionInput<float> input{
        lists, heads, {q.data(), 60, width}, {kv.data(), 60, 2 * width}};
    Matrix<float> weights = Matrix<float>::Zero(lists.edges(), heads);
    Matrix<float> out(60, width);
    AttentionWeights<float>(input, {weights.data(), lists.edges(), heads});
    MixValues<float>(input, {weights.data(), lists.edges(), heads}, {out.data(), 60, width});
    const Matrix<double> expected =
        DenseAttention(level, q.cast<double>(), kv.cast<double>(), heads);
    EXPECT_LT((out.cast<double>() - expected).cwiseAbs().maxCoeff(), 5e-6);
  }
}

/// Scores so large that exponentials overflow without care, and so small that they vanish.
TEST(Attention, IsFiniteForExtremeScores) {
  const std::int32_t start[] = {0, 2};
  const std::int32_t neighbour[] = {0, 1};
  const float q[] = {1e4F, -1e4F};
  const float kv[] = {1e4F, 0.0F, 1.0F, 2.0F, 0.0F, 1e4F, 3.0F, 4.0F};
  const AttentionInput<float> input{{1, start, neighbour}, 1, {q, 1, 2}, {kv, 2, 4}};
  float weights[2] = {};
  float out[2];
  AttentionWeights<float>(input, {weights, 2, 1});
  MixValues<float>(input, {weights, 2, 1}, {out, 1, 2});
  EXPECT_FLOAT_EQ(out[0], 1.0F);
  EXPECT_FLOAT_EQ(out[1], 2.0F);
}

/// The set that this processor does not use must not rot.
TEST(Kernels, PlainOnesAgreeWithThoseInUse) {
  std::mt19937 random(8);
  const Matrix<float> a = RandomMatrix(random, 31, 17);
  const Matrix<float> b = RandomMatrix(random, 17, 27);
  Matrix<float> c = Matrix<float>::Zero(31, 27);
  PlainKernels<float>().add_product({a.data(), 17, 1, b.data(), c.data(), 31, 17, 27});
  EXPECT_LT((c - a * b).cwiseAbs().maxCoeff(), 1e-5F);

  const GraphSample sample = BuildSample(RandomGraph(3, 40, 2), 0);
  const GraphLevel& level = sample.levels[0];
  const NeighbourLists lists{40, level.start.data(), level.neighbour.data()};
  const Matrix<float> q = RandomMatrix(random, 40, 64);
  const Matrix<float> kv = RandomMatrix(random, 40, 128);
  const AttentionInput<float> input{lists, 4, {q.data(), 40, 64}, {kv.data(), 40, 128}};
  Matrix<float> weights = Matrix<float>::Zero(lists.edges(), 4);
  AttentionWeights<float>(input, {weights.data(), lists.edges(), 4});
  Matrix<float> plain = Matrix<float>::Zero(lists.edges(), 4);
  const AttentionTask<float> task{40, lists.start, lists.neighbour, 4,
                                  16, 0.25F,       q.data(),        kv.data()};
  PlainKernels<float>().attention_scores(task, plain.data());
  PlainKernels<float>().softmax(task, plain.data());
  EXPECT_LT((plain - weights).cwiseAbs().maxCoeff(), 1e-5F);

  Matrix<float> out(40, 64);
  MixValues<float>(input, {weights.data(), lists.edges(), 4}, {out.data(), 40, 64});
  Matrix<float> plain_out(40, 64);
  PlainKernels<float>().mix_values(task, plain.data(), plain_out.data());
  EXPECT_LT((plain_out - out).cwiseAbs().maxCoeff(), 1e-5F);

  const Matrix<float> d_out = RandomMatrix(random, 40, 64);
  Matrix<float> d_q = Matrix<float>::Zero(40, 64);
  Matrix<float> d_kv = Matrix<float>::Zero(40, 128);
  AttentionBackward<float>(input, {out.data(), 40, 64}, {d_out.data(), 40, 64},
                           {weights.data(), lists.edges(), 4},
                           {{d_q.data(), 40, 64}, {d_kv.data(), 40, 128}});
  Matrix<float> plain_d_q = Matrix<float>::Zero(40, 64);
  Matrix<float> plain_d_kv = Matrix<float>::Zero(40, 128);
  PlainKernels<float>().attention_backward(
      task, {plain_out.data(), d_out.data(), plain.data(), plain_d_q.data(), plain_d_kv.data()});
  EXPECT_LT((plain_d_q - d_q).cwiseAbs().maxCoeff(), 1e-4F);
  EXPECT_LT((plain_d_kv - d_kv).cwiseAbs().maxCoeff(), 1e-4F);
}

}  // namespace
}  // namespace hv::explore::nn
