#include "hv_explore_sac/online/experience.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hv_explore_sac/policy/policy_scale.h"

namespace hv::explore {
namespace {

/// How many of the points are not among the others. Blocks may lie elsewhere, by half of one, since
/// the belief has grown.
int CountGone(const std::vector<Eigen::Vector2i>& before, const std::vector<Eigen::Vector2i>& now,
              int block) {
  return static_cast<int>(
      std::count_if(before.begin(), before.end(), [&](const Eigen::Vector2i& point) {
        return std::none_of(now.begin(), now.end(), [&](const Eigen::Vector2i& other) {
          return 2 * (other - point).cwiseAbs().maxCoeff() <= block;
        });
      }));
}

}  // namespace

ExperienceRecorder::Moment::Moment(const ExplorationModel& model)
    : free_cells(model.belief().free_count()), centroid(model.frontiers().Centroid()) {
  for (const int point : model.frontiers().points()) {
    frontiers.push_back(model.frontiers().CellOf(point));
  }
}

/// Adds to the way driven.
void ExperienceRecorder::Follow(const ExplorationModel& model) {
  const Eigen::Vector2i robot = model.graph().CellOf(model.robot());
  if (decided_) driven_ += (robot - at_).cast<double>().norm();
  at_ = robot;
}

std::optional<nn::Episode> ExperienceRecorder::Decide(const ExplorationModel& model,
                                                      const nn::GraphInput& input, int action) {
  Follow(model);
  const ViewpointConfig& places = model.config().viewpoint;
  if (decided_ && driven_ < std::min(places.spacing_x, places.spacing_y)) return std::nullopt;
  Moment now(model);
  if (decided_) episode_.steps.back().reward = RewardUntil(now, model, false);
  std::optional<nn::Episode> cut;
  if (static_cast<int>(episode_.steps.size()) >= cut_after_) {
    episode_.last = input;
    cut = Take(false);
  }
  episode_.steps.push_back({input, action, 0.0F, {}});
  decided_ = std::move(now);
  driven_ = 0.0;
  return cut;
}

std::optional<nn::Episode> ExperienceRecorder::End(const ExplorationModel& model) {
  if (!decided_) return std::nullopt;
  Follow(model);
  episode_.steps.back().reward = RewardUntil(Moment(model), model, true);
  return Take(true);
}

/// What became of the last decision is not known.
std::optional<nn::Episode> ExperienceRecorder::BreakOff() {
  if (episode_.steps.size() < 2) {
    Take(false);
    return std::nullopt;
  }
  episode_.last = std::move(episode_.steps.back().state);
  episode_.steps.pop_back();
  return Take(false);
}

std::optional<nn::Episode> ExperienceRecorder::Take(bool done) {
  decided_.reset();
  nn::Episode episode = std::exchange(episode_, nn::Episode());
  episode.done = done;
  return episode;
}

float ExperienceRecorder::RewardUntil(const Moment& now, const ExplorationModel& model,
                                      bool complete) const {
  const PolicyScale scale(model.config());
  const auto unit = static_cast<double>(scale.unit);
  const double known = std::max(1, now.free_cells);
  const int gone = CountGone(decided_->frontiers, now.frontiers, model.frontiers().block());
  Transition transition;
  transition.explored_before = std::min(1.0, decided_->free_cells / known);
  transition.explored_after = 1.0;
  transition.frontiers_observed =
      static_cast<int>(std::lround(gone * static_cast<double>(scale.point)));
  transition.has_centroids = !decided_->frontiers.empty() && !now.frontiers.empty();
  transition.centroid_before = decided_->centroid / unit;
  transition.centroid_after = now.centroid / unit;
  transition.path = driven_ / unit;
  transition.complete = complete;
  return static_cast<float>(RewardOf(transition, reward_).Total());
}

}  // namespace hv::explore
