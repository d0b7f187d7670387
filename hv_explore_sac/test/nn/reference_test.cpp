#include <map>

#include <gtest/gtest.h>

#include "hv_core/binary_io.h"
#include "hv_core/file_io.h"
#include "hv_explore_sac/nn/network.h"

namespace hv::explore::nn {
namespace {

using Arrays = std::map<std::string, Matrix<float>>;

/// What make_reference.py wrote.
Arrays ReadReference() {
  const std::string source = HV_REFERENCE_FILE;
  const std::string bytes = ReadFile(source);
  BinaryReader reader(bytes, source);
  Arrays arrays;
  for (std::size_t left = reader.GetSize(12); left > 0; --left) {
    const std::string name = reader.GetText();
    const Index rows = reader.Get<std::uint32_t>();
    const Index cols = reader.Get<std::uint32_t>();
    Matrix<float> matrix(rows, cols);
    for (Index i = 0; i < matrix.size(); ++i) matrix.data()[i] = reader.Get<float>();
    arrays[name] = matrix;
  }
  return arrays;
}

GraphSample SampleOf(const Arrays& arrays) {
  GraphInput input;
  input.features = arrays.at("features");
  input.positions = arrays.at("positions");
  input.history = arrays.at("history");
  input.globals = arrays.at("globals").row(0);
  input.current = static_cast<std::int32_t>(arrays.at("current")(0, 0));
  const Matrix<float>& actions = arrays.at("actions");
  for (Index a = 0; a < actions.cols(); ++a) {
    input.actions.push_back(static_cast<std::int32_t>(actions(0, a)));
  }
  const Matrix<float>& mask = arrays.at("mask");
  for (Index i = 0; i < mask.rows(); ++i) {
    for (Index j = 0; j < mask.cols(); ++j) {
      if (mask(i, j) > 0.0F) input.neighbour.push_back(static_cast<std::int32_t>(j));
    }
    input.start.push_back(static_cast<std::int32_t>(input.neighbour.size()));
  }
  return BuildSample(input, 2);
}

/// Largest difference as a share of the largest number.
double Difference(const Matrix<float>& a, const Matrix<float>& b) {
  const float largest = std::max(1e-6F, b.cwiseAbs().maxCoeff());
  return static_cast<double>((a - b).cwiseAbs().maxCoeff() / largest);
}

TEST(Reference, ScoresAndGradientsEqualThoseOfPyTorch) {
  const Arrays arrays = ReadReference();
  const Network<double> network({8, 2, 12, 2, 2, 6}, {4, 2, 2});
  const ParameterLayout& layout = network.layout();
  Vector<double> parameters(layout.size());
  for (const ParameterLayout::Block& block : layout.blocks()) {
    const auto found = arrays.find("parameter." + block.name);
    ASSERT_NE(found, arrays.end()) << block.name;
    ASSERT_EQ(found->second.rows(), block.slot.rows) << block.name;
    ASSERT_EQ(found->second.cols(), block.slot.cols) << block.name;
    block.slot.In(parameters.data()).matrix() = found->second.cast<double>();
  }
  const GraphSample sample = SampleOf(arrays);
  Network<double>::Workspace workspace;
  const View<double> scores = network.Forward(parameters.data(), sample, workspace);
  EXPECT_LT(Difference(scores.matrix().cast<float>(), arrays.at("scores")), 1e-6);
  Matrix<double> d_scores = arrays.at("d_scores").cast<double>();
  Vector<double> gradient = Vector<double>::Zero(layout.size());
  network.Backward(parameters.data(), {d_scores.data(), d_scores.rows(), d_scores.cols()},
                   workspace, gradient.data());
  for (const ParameterLayout::Block& block : layout.blocks()) {
    EXPECT_LT(Difference(block.slot.In(gradient.data()).matrix().cast<float>(),
                         arrays.at("gradient." + block.name)),
              2e-6)
        << block.name;
  }
}

}  // namespace
}  // namespace hv::explore::nn
