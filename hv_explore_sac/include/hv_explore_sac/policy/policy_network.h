#pragma once

#include <memory>
#include <string>

#include "hv_explore_sac/nn/batch.h"
#include "hv_explore_sac/nn/checkpoint.h"
#include "hv_explore_sac/nn/network.h"
#include "hv_explore_sac/nn/policy.h"
#include "hv_explore_sac/policy/policy_config.h"

namespace hv::explore {

/// What must be known of a policy to use its weights; the text of their file.
struct PolicySettings {
  PolicyConfig policy;
  nn::NetworkConfig network;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

/// A policy that does not change any more. Thread-safe.
class PolicyNetwork {
 public:
  PolicyNetwork(const PolicySettings& settings, Eigen::VectorXf parameters);
  /// Throws InputError for a file that is damaged or of another network.
  static std::shared_ptr<const PolicyNetwork> Read(const std::string& path);

  /// The file that Read() takes: weights and settings, nothing of their training.
  nn::Checkpoint ToCheckpoint() const;

  static nn::NetworkShape Shape();
  const PolicySettings& settings() const { return settings_; }
  const Eigen::VectorXf& parameters() const { return parameters_; }
  nn::ActionDistribution Choose(const nn::GraphInput& input) const;

 private:
  PolicySettings settings_;
  nn::Network<float> network_;
  Eigen::VectorXf parameters_;
  mutable nn::Pool<nn::Network<float>::Workspace> workspaces_;
};

}  // namespace hv::explore
