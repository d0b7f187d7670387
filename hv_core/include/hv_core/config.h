#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hv_core/error.h"

namespace YAML {
class Node;
}

namespace hv {

/// Walks over the fields of a configuration struct. Each struct describes itself once:
///
///     struct MapConfig {
///       double voxel_size_m = 0.5;
///       void Describe(ConfigVisitor& visitor) {
///         visitor.Field("voxel_size_m", voxel_size_m, "edge of a root voxel [m]");
///       }
///       void Validate(ConfigProblems& problems) const;
///     };
///
/// and the same description serves reading, writing and the parameter tables of the
/// documentation. The initialisers of the struct are the only defaults.
class ConfigVisitor {
 public:
  virtual ~ConfigVisitor() = default;
  virtual void Field(const char* name, bool& value, const char* description) = 0;
  virtual void Field(const char* name, int& value, const char* description) = 0;
  virtual void Field(const char* name, double& value, const char* description) = 0;
  virtual void Field(const char* name, std::string& value, const char* description) = 0;
  virtual void Field(const char* name, std::vector<double>& value, const char* description) = 0;

  /// A mapping of the same file that belongs to another program: accepted, not looked at.
  virtual void Foreign(const char* name) { static_cast<void>(name); }

  /// A nested struct: its fields live under the mapping `name`.
  template <typename Config>
  void Section(const char* name, Config& config, const char* description) {
    Nested(name, description, [&config](ConfigVisitor& visitor) { config.Describe(visitor); });
  }

 protected:
  using Describer = std::function<void(ConfigVisitor&)>;
  virtual void Nested(const char* name, const char* description, const Describer& describe) = 0;
};

/// Collects what is wrong with a configuration, one line each, so that all of it is reported at
/// once.
class ConfigProblems {
 public:
  /// Adds "<where>: <what>" unless `condition` holds.
  void Require(bool condition, const std::string& key, const std::string& what);
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

namespace config_detail {
void Read(const YAML::Node& node, const std::string& source,
          const std::function<void(ConfigVisitor&)>& describe,
          const std::function<void(ConfigProblems&)>& validate);
std::string Write(const std::function<void(ConfigVisitor&)>& describe);
std::string Table(const std::function<void(ConfigVisitor&)>& describe);
}  // namespace config_detail

/// Parses a YAML file or text. Throws InputError with the position of a syntax error.
YAML::Node LoadYamlFile(const std::string& path);
YAML::Node ParseYaml(const std::string& text, const std::string& source);

/// Fills `config` from `node`; keys that are absent keep their defaults. `source` names the origin
/// in messages. Throws InputError listing every unknown key (with the nearest known one), every
/// value of a wrong type and every line of Validate().
template <typename Config>
void ReadConfig(const YAML::Node& node, const std::string& source, Config& config) {
  config_detail::Read(
      node, source, [&config](ConfigVisitor& visitor) { config.Describe(visitor); },
      [&config](ConfigProblems& problems) { config.Validate(problems); });
}

/// The effective configuration as YAML that ReadConfig takes back.
template <typename Config>
std::string ToYaml(Config config) {
  return config_detail::Write([&config](ConfigVisitor& visitor) { config.Describe(visitor); });
}

/// A Markdown table of key, default and description.
template <typename Config>
std::string ParameterTable() {
  Config config;
  return config_detail::Table([&config](ConfigVisitor& visitor) { config.Describe(visitor); });
}

}  // namespace hv
