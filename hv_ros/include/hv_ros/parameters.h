#pragma once

#include <functional>
#include <string>

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include "hv_core/config.h"

namespace hv {

/// A parameter tree as YAML, so that one reader serves files and the parameter server alike. Dates
/// and binary values become their XML-RPC text, which no configuration field accepts.
YAML::Node ToYamlNode(XmlRpc::XmlRpcValue value);

/// The private parameters of a node: the file named by `~config_file`, if any; parameters laid out
/// as in the file (`~odometry/map/...`), which override it; and a few of the node's own, which are
/// taken first. Everything else is an error. Not thread-safe.
class PrivateParameters {
 public:
  /// Fetches the parameters from the server. Throws InputError when `~config_file` is no text.
  explicit PrivateParameters(const ros::NodeHandle& private_nh);

  /// Takes a parameter of the node itself; empty when it is not set. Throws InputError when it is
  /// set to something else than a text.
  std::string TakeString(const std::string& name);

  /// The same for a path, which must be absolute.
  std::string TakePath(const std::string& name);

  /// Fills `config` from the file and from what has not been taken. Throws InputError with every
  /// problem of both.
  template <typename Config>
  void Read(Config& config) const {
    ReadEach([&config](const YAML::Node& node, const std::string& source) {
      ReadConfig(node, source, config);
    });
  }

 private:
  using Reader = std::function<void(const YAML::Node&, const std::string& source)>;
  void ReadEach(const Reader& read) const;

  const std::string where_;
  XmlRpc::XmlRpcValue tree_;  ///< what has not been taken
  std::string file_;
};

}  // namespace hv
