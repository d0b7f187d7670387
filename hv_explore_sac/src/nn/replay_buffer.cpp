#include "hv_explore_sac/nn/replay_buffer.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "number_bytes.h"

namespace hv::explore::nn {
namespace {

using Halves = Matrix<Eigen::half>;

void Append(const Matrix<float>& matrix, std::vector<Eigen::half>& numbers) {
  for (Index i = 0; i < matrix.size(); ++i) numbers.emplace_back(matrix.data()[i]);
}

std::vector<std::uint16_t> Narrow(const std::vector<std::int32_t>& indices) {
  std::vector<std::uint16_t> narrow;
  narrow.reserve(indices.size());
  for (const std::int32_t index : indices) narrow.push_back(static_cast<std::uint16_t>(index));
  return narrow;
}

template <typename Value>
std::size_t BytesOf(const std::vector<Value>& values) {
  return values.capacity() * sizeof(Value);
}

}  // namespace

PackedGraph::PackedGraph(const GraphInput& input)
    : nodes_(static_cast<std::uint32_t>(input.features.rows())),
      features_(static_cast<std::uint32_t>(input.features.cols())),
      positions_(input.positions.data(), input.positions.data() + input.positions.size()),
      globals_(input.globals.data(), input.globals.data() + input.globals.size()),
      neighbours_(Narrow(input.neighbour)),
      actions_(Narrow(input.actions)),
      current_(static_cast<std::uint16_t>(input.current)) {
  if (nodes_ > std::numeric_limits<std::uint16_t>::max()) {
    throw std::invalid_argument("a graph has too many nodes to be packed");
  }
  numbers_.reserve(static_cast<std::size_t>(input.features.size() + input.history.size()));
  Append(input.features, numbers_);
  Append(input.history, numbers_);
  degrees_.reserve(nodes_);
  for (std::uint32_t i = 0; i < nodes_; ++i) {
    degrees_.push_back(static_cast<std::uint16_t>(input.start[i + 1] - input.start[i]));
  }
}

GraphInput PackedGraph::Unpack() const {
  GraphInput input;
  const Index nodes = nodes_;
  const Index features = features_;
  const Index rows = features > 0 ? static_cast<Index>(numbers_.size()) / features : 0;
  const Eigen::Map<const Halves> numbers(numbers_.data(), rows, features);
  input.features = numbers.topRows(nodes).cast<float>();
  input.history = numbers.bottomRows(rows - nodes).cast<float>();
  input.positions = Eigen::Map<const Matrix<float>>(positions_.data(), nodes, 2);
  input.globals =
      Eigen::Map<const Eigen::VectorXf>(globals_.data(), static_cast<Index>(globals_.size()));
  for (const std::uint16_t degree : degrees_) input.start.push_back(input.start.back() + degree);
  input.neighbour.assign(neighbours_.begin(), neighbours_.end());
  input.actions.assign(actions_.begin(), actions_.end());
  input.current = current_;
  return input;
}

std::size_t PackedGraph::bytes() const {
  return sizeof(PackedGraph) + BytesOf(numbers_) + BytesOf(positions_) + BytesOf(globals_) +
         BytesOf(degrees_) + BytesOf(neighbours_) + BytesOf(actions_);
}

void PackedGraph::AppendTo(std::string& bytes) const {
  AppendNumber(nodes_, bytes);
  AppendNumber(features_, bytes);
  AppendNumber(current_, bytes);
  AppendNumbers(numbers_, bytes);
  AppendNumbers(positions_, bytes);
  AppendNumbers(globals_, bytes);
  AppendNumbers(degrees_, bytes);
  AppendNumbers(neighbours_, bytes);
  AppendNumbers(actions_, bytes);
}

PackedGraph PackedGraph::TakeFrom(std::string_view& bytes) {
  PackedGraph graph;
  TakeNumber(bytes, graph.nodes_);
  TakeNumber(bytes, graph.features_);
  TakeNumber(bytes, graph.current_);
  TakeNumbers(bytes, graph.numbers_);
  TakeNumbers(bytes, graph.positions_);
  TakeNumbers(bytes, graph.globals_);
  TakeNumbers(bytes, graph.degrees_);
  TakeNumbers(bytes, graph.neighbours_);
  TakeNumbers(bytes, graph.actions_);
  return graph;
}

ReplayBuffer::ReplayBuffer(std::size_t capacity, int pyramid_levels)
    : capacity_(std::max<std::size_t>(capacity, 2)), pyramid_levels_(pyramid_levels) {}

void ReplayBuffer::Add(const Episode& episode) {
  if (episode.steps.empty()) return;
  for (const EpisodeStep& step : episode.steps) {
    const bool last = &step == &episode.steps.back();
    Push({PackedGraph(step.state), step.action, step.reward, last && episode.done, step.label});
  }
  if (!episode.done) Push({PackedGraph(episode.last), kNoAction, 0.0F, false, {}});
}

void ReplayBuffer::Push(Record record) {
  if (records_.size() < capacity_) {
    records_.push_back(std::move(record));
  } else {
    records_[next_] = std::move(record);
  }
  next_ = (next_ + 1) % capacity_;
}

bool ReplayBuffer::IsTransition(std::size_t position) const {
  const Record& record = records_[position];
  const bool newest = (position + 1) % capacity_ == next_;
  return record.action != kNoAction && (record.done || !newest);
}

std::vector<std::size_t> ReplayBuffer::Draw(std::size_t count, std::mt19937_64& random) const {
  std::vector<std::size_t> positions;
  if (transitions() == 0) return positions;
  while (positions.size() < count) {
    const std::size_t position = random() % records_.size();
    if (IsTransition(position)) positions.push_back(position);
  }
  return positions;
}

Transition ReplayBuffer::Get(std::size_t position) const {
  const Record& record = records_[position];
  Transition transition;
  transition.state = BuildSample(record.state.Unpack(), pyramid_levels_);
  transition.action = record.action;
  transition.reward = record.reward;
  transition.done = record.done;
  transition.label = record.label;
  if (!record.done) {
    const Record& next = records_[(position + 1) % records_.size()];
    transition.next = BuildSample(next.state.Unpack(), pyramid_levels_);
  }
  return transition;
}

std::string ReplayBuffer::Serialize() const {
  std::string bytes;
  AppendNumber(static_cast<std::uint64_t>(capacity_), bytes);
  AppendNumber(static_cast<std::uint64_t>(next_), bytes);
  AppendNumber(static_cast<std::uint64_t>(records_.size()), bytes);
  for (const Record& record : records_) {
    record.state.AppendTo(bytes);
    AppendNumber(record.action, bytes);
    AppendNumber(record.reward, bytes);
    AppendNumber(record.done, bytes);
    AppendNumbers(
        std::vector<float>(record.label.data(), record.label.data() + record.label.size()), bytes);
  }
  return bytes;
}

void ReplayBuffer::Restore(std::string_view bytes) {
  std::uint64_t capacity = 0;
  std::uint64_t next = 0;
  std::uint64_t count = 0;
  TakeNumber(bytes, capacity);
  TakeNumber(bytes, next);
  TakeNumber(bytes, count);
  if (capacity != capacity_ || count > capacity || next >= capacity) {
    throw InputError("a replay buffer of another capacity");
  }
  std::vector<Record> records;
  for (std::uint64_t i = 0; i < count; ++i) {
    Record record;
    record.state = PackedGraph::TakeFrom(bytes);
    TakeNumber(bytes, record.action);
    TakeNumber(bytes, record.reward);
    TakeNumber(bytes, record.done);
    std::vector<float> label;
    TakeNumbers(bytes, label);
    record.label =
        Eigen::Map<const Eigen::VectorXf>(label.data(), static_cast<Index>(label.size()));
    records.push_back(std::move(record));
  }
  records_ = std::move(records);
  next_ = static_cast<std::size_t>(next);
}

std::size_t ReplayBuffer::transitions() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < records_.size(); ++i) count += IsTransition(i) ? 1 : 0;
  return count;
}

std::size_t ReplayBuffer::bytes() const {
  std::size_t sum = 0;
  for (const Record& record : records_) {
    sum += sizeof(Record) - sizeof(PackedGraph) + record.state.bytes() +
           static_cast<std::size_t>(record.label.size()) * sizeof(float);
  }
  return sum;
}

}  // namespace hv::explore::nn
