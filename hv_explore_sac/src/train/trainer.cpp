#include "hv_explore_sac/train/trainer.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

#include <yaml-cpp/yaml.h>

#include "hv_core/error.h"
#include "hv_explore_sac/policy/policy_planner.h"
#include "hv_explore_sac/train/policy_learner.h"

namespace hv::explore {
namespace {

/// Maps for validation on which labels are made as well.
constexpr std::size_t kGaugeMaps = 30;

/// A number in state.bin, of a training that did not begin with `utility`.
constexpr const char* kBegunWithPolicy = "begun_with_policy";

std::string RoundName(int round) { return std::to_string(round + 1); }

/// What random numbers are for; each purpose in each round has its own.
enum Purpose : std::uint64_t { kLabels, kGauge, kFit, kFirstEpisodes, kEpisodes, kPurposes };

/// Everything that the labels of the first round depend on but the maps. More crossed maps come
/// after fewer.
std::string WhatLabelsDependOn(TrainConfig config) {
  config.labels.crossed = 0;
  return ToYaml(config.exploration) + ToYaml(config.planner) + ToYaml(config.guard) +
         ToYaml(config.policy) + ToYaml(config.split) + ToYaml(config.labels) +
         std::to_string(config.sac.seed);
}

constexpr std::uint64_t kSeedStep = 1U << 24U;  // more than there are maps, or episodes of SAC
constexpr std::uint64_t kCycleStep = 1000;      // more than there are episodes in a cycle

}  // namespace

Trainer::Trainer(const TrainConfig& config, const std::vector<ExplorationMap>& maps,
                 std::string folder, Ranks& ranks, Report report)
    : config_(config),
      sensor_(config.exploration.simulation),
      folder_(std::move(folder)),
      ranks_(ranks),
      archive_(folder_, ranks.rank()),
      report_(std::move(report)) {
  const auto held_out = static_cast<std::size_t>(config.split.held_out);
  const auto validation = static_cast<std::size_t>(config.split.validation);
  if (maps.size() <= held_out + validation) {
    throw InputError("there are " + std::to_string(maps.size()) +
                     " maps, and `split` leaves none of them to learn from");
  }
  const std::size_t last = maps.size() - held_out;
  for (std::size_t i = 0; i < last; ++i) {
    (i < last - validation ? training_ : validation_).push_back(&maps[i]);
  }
  std::filesystem::create_directories(folder_);
}

void Trainer::Run() {
  if (utility_travel_ == 0.0) Begin();
  while (round_ < config_.improvement.rounds) {
    RunRound();
    ++round_;
    Save();
  }
  if (cycle_ < config_.fine_tune.cycles) FineTune();
}

void Trainer::Begin() {
  archive_.Clear();
  report_("utility on the maps for validation", 0.0);
  best_travel_ = utility_travel_ = TravelOf(nullptr);
  if (last_ != nullptr) Consider(last_, TravelOf(last_));
  if (measured_) TakeOver(*measured_);
  Save();
}

void Trainer::BeginWith(const std::string& path) {
  std::shared_ptr<const PolicyNetwork> policy = PolicyNetwork::Read(path);
  const PolicySettings own{config_.policy, config_.sac.actor};
  if (ToYaml(policy->settings()) != ToYaml(own)) {
    throw InputError(path + ": has other settings than `policy` and `sac.actor`");
  }
  begun_with_policy_ = true;
  last_ = std::move(policy);
}

void Trainer::TakeLabels(const std::string& folder) {
  const std::string path = folder + "/state.bin";
  const nn::Checkpoint other = nn::Checkpoint::Read(path);
  TrainConfig config;
  ReadConfig(ParseYaml(other.text, path), path, config);
  if (WhatLabelsDependOn(config) != WhatLabelsDependOn(config_) ||
      static_cast<int>(other.Number("ranks")) != ranks_.size() || begun_with_policy_ ||
      other.HasNumber(kBegunWithPolicy)) {
    throw InputError(path + ": measured with another configuration");
  }
  measured_ = {folder, other.Number("utility_travel"), MapsOfRound(config.labels).size()};
}

void Trainer::TakeOver(const Measured& measured) const {
  if (measured.utility_travel != utility_travel_) {
    throw InputError(measured.folder + ": measured on other maps");
  }
  archive_.TakeOver(measured.folder, RoundName(0), measured.maps,
                    MapsOfRound(config_.labels).size());
}

/// Those that this rank explores.
MapSupply Trainer::MapsOfRound(const LabelConfig& labels) const {
  const std::vector<const ExplorationMap*> all = ShareOf(training_, ranks_);
  const int given = labels.maps == 0 ? static_cast<int>(all.size()) : labels.maps / ranks_.size();
  const auto count = [this](int first, int round) {
    return static_cast<std::size_t>(config_.improvement.Grown(first, round));
  };
  std::size_t taken = 0;
  for (int round = 0; round < round_; ++round) taken += count(given, round);
  MapSupply maps(InTurn(all, taken, count(given, round_)));
  maps.AddCrossed(training_, count(labels.crossed / ranks_.size(), round_), Seed(kLabels));
  return maps;
}

void Trainer::RunRound() {
  CollectLabels();
  const PolicyLearner learner(config_, round_, Seed(kFit), ranks_, [this](double share) {
    report_("round " + RoundName(round_) + ": learning", share);
  });
  last_ = learner.Learn(labels_, gauge_, begun_with_policy_ ? last_ : nullptr, curve_);
  Judge(last_);
}

Rollout Trainer::RolloutOf(std::shared_ptr<const PolicyNetwork> network) const {
  if (network != nullptr) {
    return Rollout(
        [network](const ExplorationMap&) { return std::make_unique<PolicyPlanner>(network); },
        config_.guard);
  }
  return Rollout(
      [this](const ExplorationMap& map) {
        return MakePlanner("utility", {config_.planner, config_.exploration, &sensor_, &map});
      },
      config_.guard);
}

void Trainer::CollectLabels() {
  Label(RoundName(round_), config_.labels, MapsOfRound(config_.labels), Seed(kLabels));
  std::vector<const ExplorationMap*> few = validation_;
  few.resize(std::min(few.size(), kGaugeMaps));
  LabelConfig all_tried = config_.labels;
  all_tried.contenders = 0.0;
  gauge_ = Label("gauge_" + RoundName(round_), all_tried, MapSupply(few), Seed(kGauge));
  labels_.clear();
  for (int round = std::max(0, round_ + 1 - config_.improvement.kept_rounds); round <= round_;
       ++round) {
    std::vector<LabelledState> more = archive_.Read(RoundName(round));
    std::move(more.begin(), more.end(), std::back_inserter(labels_));
  }
  if (labels_.empty()) {
    throw InputError("round " + RoundName(round_) +
                     ": `labels` and the maps give no decision with a choice to learn from");
  }
}

std::vector<LabelledState> Trainer::Label(const std::string& name, const LabelConfig& labels,
                                          const MapSupply& maps, std::uint64_t seed) const {
  const Rollout rollout = RolloutOf(last_);
  LabelInputs inputs{config_.exploration, config_.policy, labels, &sensor_, &rollout};
  inputs.network = last_.get();
  inputs.temperature = config_.sac.temperature;
  return archive_.Collect(name, maps, inputs, seed, [this](double share) {
    report_("round " + RoundName(round_) + ": measuring", share);
  });
}

std::unique_ptr<FineTuner> Trainer::MakeFineTuner() {
  const EpisodeInputs inputs{config_.exploration, config_.policy, config_.reward, &sensor_};
  auto tuner =
      std::make_unique<FineTuner>(config_.fine_tune, inputs, config_.sac, training_, ranks_);
  if (cycle_ > 0) {
    tuner->Load(PathOf("sac.bin"), RankPath("replay"));
    return tuner;
  }
  report_("SAC: first episodes and values", 0.0);
  tuner->Begin(best_->parameters(), Seed(kFirstEpisodes));
  return tuner;
}

void Trainer::FineTune() {
  if (best_ == nullptr) return;
  const std::unique_ptr<FineTuner> tuner = MakeFineTuner();
  const FineTuneConfig& config = config_.fine_tune;
  while (cycle_ < config.cycles) {
    CurvePoint now;
    now.round = config_.improvement.rounds + 1;
    const int first = cycle_;
    const int next = std::min(config.cycles, first + config.judge_every);
    for (; cycle_ < next; ++cycle_) {
      report_("SAC", static_cast<double>(cycle_) / config.cycles);
      now.loss = tuner->Cycle(Seed(kEpisodes) + static_cast<std::uint64_t>(cycle_) * kCycleStep)
                     .critic_loss;
    }
    now.updates = curve_.back().updates + (cycle_ - first) * config.updates;
    now.states = static_cast<int>(tuner->states());
    now.gain = std::numeric_limits<double>::quiet_NaN();
    curve_.push_back(now);
    Judge(std::make_shared<PolicyNetwork>(PolicySettings{config_.policy, config_.sac.actor},
                                          tuner->sac().actor_parameters()));
    tuner->Save(PathOf("sac.bin"), RankPath("replay"));
    Save();
  }
}

void Trainer::Judge(std::shared_ptr<const PolicyNetwork> candidate) {
  report_("trying", 0.0);
  const double travel = TravelOf(candidate);
  curve_.back().travel = travel;
  curve_.back().share = travel / utility_travel_;
  Consider(std::move(candidate), travel);
}

double Trainer::TravelOf(std::shared_ptr<const PolicyNetwork> policy) const {
  return Validate(validation_, config_.exploration, sensor_, RolloutOf(std::move(policy)), ranks_)
      .travel;
}

void Trainer::Consider(std::shared_ptr<const PolicyNetwork> candidate, double travel) {
  if (travel >= best_travel_) return;
  best_travel_ = travel;
  best_ = std::move(candidate);
}

void Trainer::Save() const {
  if (ranks_.rank() != 0) return;
  if (best_ != nullptr) best_->ToCheckpoint().Write(PathOf("policy.bin"));
  if (last_ != nullptr) last_->ToCheckpoint().Write(PathOf("last.bin"));
  WriteCurve(curve_, PathOf("curve.csv"));
  nn::Checkpoint state;
  state.text = ToYaml(config_);
  state.PutNumber("round", round_);
  state.PutNumber("cycle", cycle_);
  state.PutNumber("ranks", ranks_.size());
  if (begun_with_policy_) state.PutNumber(kBegunWithPolicy, 1.0);
  state.PutNumber("utility_travel", utility_travel_);
  state.PutNumber("best_travel", best_travel_);
  state.Write(PathOf("state.bin"));
}

void Trainer::Resume() {
  const nn::Checkpoint state = nn::Checkpoint::Read(PathOf("state.bin"));
  TrainConfig config;
  ReadConfig(ParseYaml(state.text, PathOf("state.bin")), PathOf("state.bin"), config);
  config.improvement.rounds = config_.improvement.rounds;
  config.fine_tune.cycles = config_.fine_tune.cycles;
  if (ToYaml(config) != ToYaml(config_)) {
    throw InputError(PathOf("state.bin") + ": was made with another configuration");
  }
  const int ranks = static_cast<int>(state.Number("ranks"));
  if (ranks != ranks_.size()) {
    throw InputError(PathOf("state.bin") + ": was made by " + std::to_string(ranks) + " ranks");
  }
  round_ = static_cast<int>(state.Number("round"));
  cycle_ = static_cast<int>(state.Number("cycle"));
  utility_travel_ = state.Number("utility_travel");
  best_travel_ = state.Number("best_travel");
  if (best_travel_ < utility_travel_) best_ = PolicyNetwork::Read(PathOf("policy.bin"));
  begun_with_policy_ = state.HasNumber(kBegunWithPolicy);
  if (round_ > 0 || begun_with_policy_) last_ = PolicyNetwork::Read(PathOf("last.bin"));
  curve_ = ReadCurve(PathOf("curve.csv"));
}

std::string Trainer::RankPath(const std::string& name) const {
  return PathOf(name + "_" + std::to_string(ranks_.rank()) + ".bin");
}

std::uint64_t Trainer::Seed(std::uint64_t purpose) const {
  const auto round = static_cast<std::uint64_t>(round_);
  const auto size = static_cast<std::uint64_t>(ranks_.size());
  const std::uint64_t stream =
      (round * kPurposes + purpose) * size + static_cast<std::uint64_t>(ranks_.rank());
  return static_cast<std::uint64_t>(config_.sac.seed) * 1000003U + stream * kSeedStep;
}

}  // namespace hv::explore
