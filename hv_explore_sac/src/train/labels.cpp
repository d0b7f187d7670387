#include "hv_explore_sac/train/labels.h"

#include <atomic>
#include <cmath>
#include <optional>
#include <random>

#include <tbb/parallel_for.h>

#include "hv_explore_sac/policy/policy_input.h"
#include "uniform.h"

namespace hv::explore {
namespace {

/// One run on a map with measurements on the way.
class LabelRun {
 public:
  LabelRun(const ExplorationMap& map, const LabelInputs& inputs, std::uint64_t seed)
      : inputs_(inputs),
        environment_(inputs.exploration, RewardConfig(), *inputs.sensor, map,
                     std::make_shared<SightMemory>(*inputs.sensor, map)),
        planner_(inputs.rollout->MakePlanner(map)),
        builder_(inputs.policy),
        random_(seed) {}

  std::vector<LabelledState> Run() {
    while (environment_.ending() == Ending::kRunning) {
      environment_.Observe(observation_);
      builder_.Build(observation_, environment_.model(), kept_, input_);
      if (Uniform(random_) < inputs_.labels.share && builder_.goals().size() > 1) Measure();
      if (Uniform(random_) < inputs_.labels.wander) Wander();
      if (wish_ && StepTowards(environment_, *wish_)) continue;
      wish_.reset();
      Follow();
    }
    return std::move(labels_);
  }

 private:
  Eigen::Vector2i CellOf(int node) const {
    return environment_.model().graph().CellOf(observation_.node(node).viewpoint);
  }

  void Measure() {
    const Eigen::VectorXf preference = Preferences();
    const float least = preference.maxCoeff() + LeastPreference();
    const Eigen::Index contenders = (preference.array() >= least).count();
    if (contenders < 2) return;
    Eigen::VectorXf returns(preference.size());
    float implied = 0.0F;  // by a preference of zero
    for (Eigen::Index i = 0; i < returns.size(); ++i) {
      if (preference[i] < least) continue;
      const Goal& goal = builder_.goals()[static_cast<std::size_t>(i)];
      const double travel = inputs_.rollout->TravelVia(environment_, CellOf(goal.node));
      returns[i] = static_cast<float>(-travel / inputs_.labels.length_scale);
      implied += (returns[i] - preference[i]) / static_cast<float>(contenders);
    }
    for (Eigen::Index i = 0; i < returns.size(); ++i) {
      if (preference[i] < least) returns[i] = implied + preference[i];
    }
    labels_.push_back({nn::PackedGraph(input_), returns});
  }

  /// Of the goals [returns].
  Eigen::VectorXf Preferences() const {
    if (inputs_.network == nullptr) {
      return Eigen::VectorXf::Zero(static_cast<Eigen::Index>(builder_.goals().size()));
    }
    return static_cast<float>(inputs_.temperature) *
           inputs_.network->Choose(input_).log_probability;
  }

  /// Of a contender, below the favourite's [returns].
  float LeastPreference() const {
    return static_cast<float>(inputs_.temperature * std::log(inputs_.labels.contenders));
  }

  void Wander() {
    const std::vector<Goal>& goals = builder_.goals();
    wish_ = CellOf(goals[random_() % goals.size()].node);
    kept_ = wish_;
  }

  void Follow() {
    const Decision decision = planner_->Choose(observation_, environment_.model());
    kept_ = CellOf(decision.goal);
    environment_.Step(observation_.node(decision.action).viewpoint);
  }

  const LabelInputs& inputs_;
  DungeonEnvironment environment_;
  std::unique_ptr<Planner> planner_;
  PolicyInput builder_;
  std::mt19937_64 random_;
  Observation observation_;
  nn::GraphInput input_;
  std::optional<Eigen::Vector2i> kept_;  ///< the goal that the robot has: a cell
  std::optional<Eigen::Vector2i> wish_;  ///< while it wanders
  std::vector<LabelledState> labels_;
};

/// The map, or one with another start.
ExplorationMap Started(const ExplorationMap& map, double elsewhere, std::uint64_t seed) {
  ExplorationMap started = map;
  std::mt19937_64 random(seed);
  if (Uniform(random) >= elsewhere || map.CountFree() == 0) return started;
  while (true) {
    const int index = static_cast<int>(random() % map.free.size());
    if (!map.IsFree(index)) continue;
    started.start = {index % map.width, index / map.width};
    return started;
  }
}

}  // namespace

void LabelConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("share", share, "of the decisions of a run whose goals are measured");
  visitor.Field("contenders", contenders,
                "goals less probable than this share of the policy's favourite are not tried");
  visitor.Field("wander", wander, "share of the decisions at which any goal is driven to instead");
  visitor.Field("elsewhere", elsewhere, "share of the runs that start anywhere free in their map");
  visitor.Field("maps", maps, "of those for training, in turn and over again; 0: each once");
  visitor.Field("crossed", crossed,
                "maps made out of two of those for training, beside these, new in each round");
  visitor.Field("length_scale", length_scale, "way that costs a return of one [cells]");
}

void LabelConfig::Validate(ConfigProblems& problems) const {
  problems.Require(share > 0.0 && share <= 1.0, "labels.share", "must be above 0 and at most 1");
  problems.Require(contenders >= 0.0 && contenders < 1.0, "labels.contenders",
                   "must be at least 0 and below 1");
  problems.Require(wander >= 0.0 && wander < 1.0, "labels.wander", "must be within 0 and 1");
  problems.Require(elsewhere >= 0.0 && elsewhere <= 1.0, "labels.elsewhere",
                   "must be within 0 and 1");
  problems.Require(maps >= 0, "labels.maps", "must not be negative");
  problems.Require(crossed >= 0, "labels.crossed", "must not be negative");
  problems.Require(length_scale > 0.0, "labels.length_scale", "must be positive");
}

std::vector<LabelledState> LabelMap(const ExplorationMap& map, const LabelInputs& inputs,
                                    std::uint64_t seed) {
  constexpr std::uint64_t kOfStart = 0x5bd1e995;
  const ExplorationMap started = Started(map, inputs.labels.elsewhere, seed ^ kOfStart);
  return LabelRun(started, inputs, seed).Run();
}

std::vector<LabelledState> LabelMaps(const MapSupply& maps, std::size_t begin, std::size_t end,
                                     const LabelInputs& inputs, std::uint64_t seed,
                                     const std::function<void(double)>& report) {
  std::vector<std::vector<LabelledState>> parts(end - begin);
  std::atomic<std::size_t> done{0};
  tbb::parallel_for(begin, end, [&](std::size_t i) {
    parts[i - begin] = LabelMap(maps.Map(i), inputs, seed + i);
    report(static_cast<double>(++done) / static_cast<double>(end - begin));
  });
  std::vector<LabelledState> labels;
  for (std::vector<LabelledState>& part : parts) {
    std::move(part.begin(), part.end(), std::back_inserter(labels));
  }
  return labels;
}

}  // namespace hv::explore
