#pragma once

#include <string>

#include <yaml-cpp/yaml.h>

#include "hv_core/error.h"

namespace hv {

/// What stands under `key`. Throws InputError, naming `source`, when it is missing or no T.
template <typename T>
T YamlValue(const YAML::Node& node, const char* key, const std::string& source) {
  try {
    return node[key].as<T>();
  } catch (const YAML::Exception&) {
    throw InputError(source + ": key '" + key + "' is missing or has the wrong type");
  }
}

}  // namespace hv
