#include "hv_explore_sac/online/online_learner.h"

#include <filesystem>
#include <limits>
#include <utility>

#include <sys/resource.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "hv_explore_sac/policy/policy_input.h"
#include "hv_explore_sac/train/episode.h"

namespace hv::explore {
namespace {

nn::SacConfig SacOf(const OnlineLearningConfig& config, const nn::NetworkConfig& network) {
  nn::SacConfig sac;
  sac.actor = sac.critic = network;
  sac.actor_optimiser.learning_rate = sac.critic_optimiser.learning_rate = config.learning_rate;
  sac.discount = config.discount;
  sac.temperature = config.temperature;
  sac.prior_weight = config.prior_weight;
  sac.prior_half_life = std::numeric_limits<double>::infinity();
  return sac;
}

void MakeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder + ": cannot be made, " + error.message());
}

/// What drives the robot goes first.
void LowerPriority() {
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
}

}  // namespace

OnlineLearner::OnlineLearner(const OnlineLearningConfig& config, const PolicyNetwork& policy)
    : config_(config),
      settings_(policy.settings()),
      sac_(SacOf(config, settings_.network), PolicyNetwork::Shape(), PolicyInput::kGlobals),
      replay_(static_cast<std::size_t>(config.capacity), settings_.network.pyramid_levels),
      returns_(static_cast<std::size_t>(config.capacity), settings_.network.pyramid_levels) {
  sac_.AdoptActor(policy.parameters());
  sac_.KeepPrior();
  MakeFolder(config.folder);
  if (std::filesystem::exists(PathOf("learner.bin"))) Load();
  random_.seed(static_cast<std::uint64_t>(sac_.updates()) + 1);
  thread_ = std::thread(&OnlineLearner::Run, this);
}

OnlineLearner::~OnlineLearner() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void OnlineLearner::Load() {
  const nn::Checkpoint learner = nn::Checkpoint::Read(PathOf("learner.bin"));
  if (learner.text != ToYaml(settings_)) {
    throw InputError(PathOf("learner.bin") + ": was learned with another kind of policy");
  }
  sac_.Load(learner);
  value_updates_ = static_cast<int>(learner.Number("value_updates"));
  replay_.Restore(ReadFile(PathOf("replay.bin")));
  status_.decisions = replay_.transitions();
  status_.updates = sac_.updates();
}

void OnlineLearner::Add(nn::Episode episode) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.push_back(std::move(episode));
  }
  changed_.notify_all();
}

void OnlineLearner::Wait() const {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty() && !busy_; });
}

OnlineLearningStatus OnlineLearner::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

bool OnlineLearner::Stopping() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return stop_;
}

void OnlineLearner::Run() {
  LowerPriority();
  tbb::task_arena one_thread(1);
  while (true) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return stop_ || !waiting_.empty(); });
    if (waiting_.empty()) break;
    const nn::Episode episode = std::move(waiting_.front());
    waiting_.pop_front();
    busy_ = true;
    lock.unlock();
    one_thread.execute([&] { Learn(episode); });
    if (episode.done) Save();
    lock.lock();
    busy_ = false;
    changed_.notify_all();
  }
  Save();
}

void OnlineLearner::Learn(const nn::Episode& episode) {
  replay_.Add(episode);
  if (value_updates_ < config_.value_updates) returns_.Add(WithReturns(episode, config_.discount));
  const std::size_t updates = static_cast<std::size_t>(config_.updates) * episode.steps.size();
  for (std::size_t i = 0; i < updates && !Stopping(); ++i) Update();
}

void OnlineLearner::Update() {
  const auto batch = static_cast<std::size_t>(config_.batch);
  double loss = 0.0;
  if (value_updates_ < config_.value_updates) {
    const std::vector<std::size_t> drawn = returns_.Draw(batch, random_);
    if (drawn.empty()) return;
    loss = sac_.RegressValues(batch, [&](std::size_t i) { return returns_.Get(drawn[i]); });
    ++value_updates_;
  } else {
    const std::vector<std::size_t> drawn = replay_.Draw(batch, random_);
    const auto fetch = [&](std::size_t i) { return replay_.Get(drawn[i]); };
    loss = sac_.Update(batch, fetch).critic_loss;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.decisions = replay_.transitions();
  status_.updates = sac_.updates();
  status_.critic_loss = loss;
}

void OnlineLearner::Save() {
  std::string problem;
  try {
    nn::Checkpoint learner;
    learner.text = ToYaml(settings_);
    sac_.Save(learner);
    learner.PutNumber("value_updates", value_updates_);
    WriteFile(PathOf("replay.bin"), {replay_.Serialize()});
    learner.Write(PathOf("learner.bin"));
    PolicyNetwork(settings_, sac_.actor_parameters()).ToCheckpoint().Write(PathOf("policy.bin"));
  } catch (const InputError& error) {
    problem = error.what();
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.problem = problem;
}

std::shared_ptr<OnlineLearner> MakeOnlineLearner(const OnlineLearningConfig& config,
                                                 const std::string& weights) {
  if (!config.enabled) return nullptr;
  return std::make_shared<OnlineLearner>(config, *PolicyNetwork::Read(weights));
}

}  // namespace hv::explore
