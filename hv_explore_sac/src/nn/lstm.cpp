#include "hv_explore_sac/nn/lstm.h"

#include <cmath>

#include "hv_explore_sac/nn/kernels.h"

namespace hv::explore::nn {
namespace {

template <typename Scalar>
View<Scalar> Row(View<Scalar> view, Index i) {
  return {view.row(i), 1, view.cols};
}

/// From the weighted inputs of one step to its gates, cell and hidden state.
template <typename Scalar>
void Step(Scalar* gates, const Scalar* before, Scalar* cell, Scalar* hidden, Index width) {
  using Array = Eigen::Map<Eigen::Array<Scalar, Eigen::Dynamic, 1>>;
  using ConstArray = Eigen::Map<const Eigen::Array<Scalar, Eigen::Dynamic, 1>>;
  Array open(gates, 2 * width);
  Array candidate(gates + 2 * width, width);
  Array output(gates + 3 * width, width);
  open = (Scalar(1) + (-open).exp()).inverse();
  candidate = candidate.tanh();
  output = (Scalar(1) + (-output).exp()).inverse();
  Array now(cell, width);
  now = open.tail(width) * ConstArray(before, width) + open.head(width) * candidate;
  Array(hidden, width) = output * now.tanh();
}

/// Gradients of one step's weighted inputs; `d_cell` becomes that of the cell before.
template <typename Scalar>
void StepBackward(const Scalar* gates, const Scalar* before, const Scalar* cell,
                  const Scalar* d_hidden, Scalar* d_cell, Scalar* d_gates, Index width) {
  for (Index j = 0; j < width; ++j) {
    const Scalar input = gates[j];
    const Scalar forget = gates[width + j];
    const Scalar candidate = gates[2 * width + j];
    const Scalar output = gates[3 * width + j];
    const Scalar squashed = std::tanh(cell[j]);
    const Scalar d_now = d_cell[j] + d_hidden[j] * output * (1 - squashed * squashed);
    d_gates[j] = d_now * candidate * input * (1 - input);
    d_gates[width + j] = d_now * before[j] * forget * (1 - forget);
    d_gates[2 * width + j] = d_now * input * (1 - candidate * candidate);
    d_gates[3 * width + j] = d_hidden[j] * squashed * output * (1 - output);
    d_cell[j] = d_now * forget;
  }
}

}  // namespace

template <typename Scalar>
Lstm<Scalar>::Lstm(ParameterLayout& layout, const std::string& name, Index inputs, Index width)
    : input_(layout, name + ".input", inputs, 4 * width),
      recurrent_(layout.Add(name + ".recurrent", width, 4 * width, Init::kGlorot)) {}

template <typename Scalar>
View<Scalar> Lstm<Scalar>::Forward(const Scalar* parameters, Arena<Scalar>& arena,
                                   View<const Scalar> x, Saved& saved) const {
  saved.x = x;
  saved.gates = arena.Take(x.rows, 4 * width());
  saved.cell = arena.TakeZero(x.rows + 1, width());
  saved.hidden = arena.TakeZero(x.rows + 1, width());
  input_.Forward(parameters, x, saved.gates);
  for (Index t = 0; t < x.rows; ++t) {
    AddProduct<Scalar>(Row(saved.hidden, t), recurrent_.In(parameters), Row(saved.gates, t));
    Step(saved.gates.row(t), saved.cell.row(t), saved.cell.row(t + 1), saved.hidden.row(t + 1),
         width());
  }
  return Row(saved.hidden, x.rows);
}

template <typename Scalar>
void Lstm<Scalar>::Backward(const Backprop<Scalar>& pass, const Saved& saved,
                            View<const Scalar> d_last) const {
  const typename Arena<Scalar>::Scope scope(pass.arena);
  const Index steps = saved.x.rows;
  const View<Scalar> transposed = pass.arena.Take(4 * width(), width());
  transposed.matrix() = recurrent_.In(pass.parameters).matrix().transpose();
  const View<Scalar> d_gates = pass.arena.Take(steps, 4 * width());
  const View<Scalar> d_cell = pass.arena.TakeZero(1, width());
  const View<Scalar> d_hidden = pass.arena.Take(1, width());
  d_hidden.matrix() = d_last.matrix();
  for (Index t = steps - 1; t >= 0; --t) {
    StepBackward<Scalar>(saved.gates.row(t), saved.cell.row(t), saved.cell.row(t + 1),
                         d_hidden.data, d_cell.data, d_gates.row(t), width());
    d_hidden.matrix().setZero();
    AddProduct<Scalar>(Row(d_gates, t), transposed, d_hidden);
  }
  const View<const Scalar> before(saved.hidden.data, steps, width());
  AddTransposedProduct<Scalar>(before, d_gates, recurrent_.In(pass.gradient));
  input_.Backward(pass, saved.x, d_gates, {});
}

template class Lstm<float>;
template class Lstm<double>;

}  // namespace hv::explore::nn
