#include "hv_explore_sac/policy/policy_network.h"

#include <utility>

#include <yaml-cpp/yaml.h>

#include "hv_core/error.h"
#include "hv_explore_sac/policy/policy_input.h"

namespace hv::explore {
namespace {

constexpr const char* kPrefix = "actor";

/// Throws InputError in one line: a file of something else may differ in every key.
PolicySettings ReadSettings(const std::string& text, const std::string& path) {
  PolicySettings settings;
  try {
    ReadConfig(ParseYaml(text, "its settings"), "its settings", settings);
  } catch (const InputError& error) {
    const std::string problems = error.what();
    throw InputError(path + ": holds no policy; " + problems.substr(0, problems.find('\n')));
  }
  return settings;
}

}  // namespace

void PolicySettings::Describe(ConfigVisitor& visitor) {
  visitor.Section("policy", policy, "what the learned policy chooses among");
  visitor.Section("network", network, "size of the network");
}

void PolicySettings::Validate(ConfigProblems& problems) const {
  policy.Validate(problems);
  network.Validate(problems);
}

PolicyNetwork::PolicyNetwork(const PolicySettings& settings, Eigen::VectorXf parameters)
    : settings_(settings),
      network_(settings.network, Shape()),
      parameters_(std::move(parameters)) {}

nn::NetworkShape PolicyNetwork::Shape() {
  return {PolicyInput::kFeatures, PolicyInput::kGlobals, 1};
}

std::shared_ptr<const PolicyNetwork> PolicyNetwork::Read(const std::string& path) {
  const nn::Checkpoint checkpoint = nn::Checkpoint::Read(path);
  const PolicySettings settings = ReadSettings(checkpoint.text, path);
  const nn::Network<float> network(settings.network, Shape());
  return std::make_shared<PolicyNetwork>(settings,
                                         checkpoint.Parameters(kPrefix, network.layout()));
}

nn::Checkpoint PolicyNetwork::ToCheckpoint() const {
  nn::Checkpoint checkpoint;
  checkpoint.text = ToYaml(settings_);
  checkpoint.Put(kPrefix, network_.layout(), parameters_);
  return checkpoint;
}

nn::ActionDistribution PolicyNetwork::Choose(const nn::GraphInput& input) const {
  const nn::Pool<nn::Network<float>::Workspace>::Loan workspace(workspaces_);
  const nn::GraphSample sample = nn::BuildSample(input, settings_.network.pyramid_levels);
  return nn::ToDistribution(network_.Forward(parameters_.data(), sample, *workspace));
}

}  // namespace hv::explore
