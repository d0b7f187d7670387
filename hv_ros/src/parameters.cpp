#include "hv_ros/parameters.h"

#include <sstream>

#include <ros/param.h>
#include <yaml-cpp/yaml.h>

#include "hv_core/error.h"

namespace hv {
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

XmlRpcValue TreeOf(const std::string& where) {
  XmlRpcValue tree;
  if (!ros::param::get(where, tree)) tree.begin();
  return tree;
}

/// The members of a tree except one.
XmlRpcValue Without(const std::string& name, XmlRpcValue tree) {
  XmlRpcValue rest;
  rest.begin();
  for (auto& [key, child] : tree) {
    if (key != name) rest[key] = child;
  }
  return rest;
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

PrivateParameters::PrivateParameters(const ros::NodeHandle& private_nh)
    : where_(private_nh.getNamespace()),
      tree_(Without("diagnostic_period", TreeOf(where_))),  // that is diagnostic_updater's own
      file_(TakeString("config_file")) {}

std::string PrivateParameters::TakeString(const std::string& name) {
  if (!tree_.hasMember(name)) return "";
  if (tree_[name].getType() != XmlRpcValue::TypeString) {
    throw InputError(where_ + "/" + name + ": expected a text");
  }
  std::string value = static_cast<std::string>(tree_[name]);
  tree_ = Without(name, tree_);
  return value;
}

std::string PrivateParameters::TakePath(const std::string& name) {
  std::string path = TakeString(name);
  if (!path.empty() && path.front() != '/') {
    throw InputError(where_ + "/" + name + ": '" + path + "' is not an absolute path");
  }
  return path;
}

void PrivateParameters::ReadEach(const Reader& read) const {
  std::string problems;
  const auto add_problems_of = [&](const YAML::Node& node, const std::string& source) {
    try {
      read(node, source);
    } catch (const InputError& error) {
      problems += (problems.empty() ? "" : "\n") + std::string(error.what());
    }
  };
  if (!file_.empty()) add_problems_of(LoadYamlFile(file_), file_);
  add_problems_of(ToYamlNode(tree_), "parameters of " + where_);
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace hv
