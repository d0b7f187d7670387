#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "hv_explore_sac/nn/graph_sample.h"

namespace hv::explore::nn {

/// A graph as the replay buffer keeps it: features in half precision, indices in 16 bits, and
/// nothing that BuildSample() makes anew. About 20 kB for 300 nodes with 20 neighbours.
class PackedGraph {
 public:
  PackedGraph() = default;
  /// Throws std::invalid_argument for more than 65535 nodes.
  explicit PackedGraph(const GraphInput& input);
  GraphInput Unpack() const;
  std::size_t bytes() const;

  /// Appends itself to `bytes`, in the order of bytes of this machine.
  void AppendTo(std::string& bytes) const;
  /// Takes what AppendTo() wrote off the front of `bytes`. Throws InputError when it is cut short.
  static PackedGraph TakeFrom(std::string_view& bytes);

 private:
  std::uint32_t nodes_ = 0;
  std::uint32_t features_ = 0;
  std::vector<Eigen::half> numbers_;  // features, then history
  std::vector<float> positions_;
  std::vector<float> globals_;
  std::vector<std::uint16_t> degrees_;
  std::vector<std::uint16_t> neighbours_;
  std::vector<std::uint16_t> actions_;
  std::uint16_t current_ = 0;
};

/// One decision of an episode and what came of it.
struct EpisodeStep {
  GraphInput state;
  /// Position in the state's list of actions.
  int action = 0;
  float reward = 0.0F;
  /// What an oracle would do, as probabilities over the actions; empty without one.
  Eigen::VectorXf label;
};

struct Episode {
  std::vector<EpisodeStep> steps;
  /// The task ended with the last step. Otherwise the episode was cut, and `last` follows it.
  bool done = true;
  GraphInput last;
};

/// One transition as learning reads it; `next` is empty when `done`.
struct Transition {
  GraphSample state;
  int action = 0;
  float reward = 0.0F;
  bool done = false;
  GraphSample next;
  Eigen::VectorXf label;
  /// What each action was measured to bring until the end; empty where that is not known.
  Eigen::VectorXf returns;
};

/// A ring of transitions: the oldest make way. A state is kept once although it is the end of one
/// transition and the start of another. Reading is thread-safe while nobody adds.
class ReplayBuffer {
 public:
  /// `capacity` states.
  ReplayBuffer(std::size_t capacity, int pyramid_levels);

  void Add(const Episode& episode);
  /// Positions of `count` transitions, uniform with replacement. Empty while there are none.
  std::vector<std::size_t> Draw(std::size_t count, std::mt19937_64& random) const;
  Transition Get(std::size_t position) const;

  /// All that it holds, in the order of bytes of this machine.
  std::string Serialize() const;
  /// Throws InputError for what is cut short or was made with another capacity.
  void Restore(std::string_view bytes);

  std::size_t states() const { return records_.size(); }
  std::size_t transitions() const;
  std::size_t bytes() const;

 private:
  struct Record {
    PackedGraph state;
    int action = kNoAction;
    float reward = 0.0F;
    bool done = false;
    Eigen::VectorXf label;
  };
  static constexpr int kNoAction = -1;

  void Push(Record record);
  bool IsTransition(std::size_t position) const;

  std::size_t capacity_;
  int pyramid_levels_;
  std::vector<Record> records_;
  std::size_t next_ = 0;
};

}  // namespace hv::explore::nn
