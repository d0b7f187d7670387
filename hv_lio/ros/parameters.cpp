#include "parameters.h"

#include <sstream>

#include <ros/param.h>
#include <yaml-cpp/yaml.h>

#include "hv_core/config.h"
#include "hv_core/error.h"

namespace hv::lio {
namespace {

using XmlRpc::XmlRpcValue;

YAML::Node DoubleNode(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return YAML::Node(text.str());
}

YAML::Node ArrayNode(XmlRpcValue& value) {
  YAML::Node node(YAML::NodeType::Sequence);
  for (int i = 0; i < value.size(); ++i) node.push_back(ToYamlNode(value[i]));
  return node;
}

YAML::Node StructNode(XmlRpcValue& value) {
  YAML::Node node(YAML::NodeType::Map);
  for (auto& [key, child] : value) node[key] = ToYamlNode(child);
  return node;
}

/// Takes a parameter that belongs to the node, not to the configuration, out of the tree.
std::string TakeString(const char* name, const std::string& where, XmlRpcValue& tree) {
  if (!tree.hasMember(name)) return "";
  if (tree[name].getType() != XmlRpcValue::TypeString) {
    throw InputError(where + "/" + name + ": expected a string");
  }
  return static_cast<std::string>(tree[name]);
}

XmlRpcValue PrivateTree(const ros::NodeHandle& private_nh) {
  XmlRpcValue tree;
  if (!ros::param::get(private_nh.getNamespace(), tree)) tree.begin();
  return tree;
}

/// Reads one source and adds its problems to `problems` instead of throwing.
void ReadInto(const YAML::Node& node, const std::string& source, SystemConfig& config,
              std::string& problems) {
  try {
    ReadConfig(node, source, config);
  } catch (const InputError& error) {
    problems += (problems.empty() ? "" : "\n") + std::string(error.what());
  }
}

}  // namespace

YAML::Node ToYamlNode(XmlRpcValue value) {
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool>(value) ? "true" : "false");
    case XmlRpcValue::TypeInt:
      return YAML::Node(std::to_string(static_cast<int>(value)));
    case XmlRpcValue::TypeDouble:
      return DoubleNode(static_cast<double>(value));
    case XmlRpcValue::TypeString:
      return YAML::Node(static_cast<std::string>(value));
    case XmlRpcValue::TypeArray:
      return ArrayNode(value);
    case XmlRpcValue::TypeStruct:
      return StructNode(value);
    default:
      return YAML::Node(value.toXml());
  }
}

NodeParameters ReadParameters(const ros::NodeHandle& private_nh) {
  const std::string where = private_nh.getNamespace();
  XmlRpcValue tree = PrivateTree(private_nh);
  NodeParameters parameters;
  parameters.save_trajectory = TakeString("save_trajectory", where, tree);
  const std::string file = TakeString("config_file", where, tree);

  std::string problems;
  if (!file.empty()) ReadInto(LoadYamlFile(file), file, parameters.config, problems);
  YAML::Node node = ToYamlNode(tree);
  for (const char* name : {"config_file", "save_trajectory", "diagnostic_period"}) {
    node.remove(name);
  }
  ReadInto(node, "parameters of " + where, parameters.config, problems);
  if (!problems.empty()) throw InputError(problems);
  return parameters;
}

}  // namespace hv::lio
