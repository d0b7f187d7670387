#pragma once

#include <string>
#include <vector>

namespace hv::replay {

/// Builds the text of one JSON object, keys in the order of the calls. Numbers that are not finite
/// become null.
class JsonObject {
 public:
  JsonObject& Add(const std::string& key, double value);
  JsonObject& Add(const std::string& key, bool value);
  JsonObject& Add(const std::string& key, const std::string& value);
  JsonObject& Add(const std::string& key, const char* value);
  JsonObject& Add(const std::string& key, const JsonObject& value);
  JsonObject& Add(const std::string& key, const std::vector<double>& values);
  JsonObject& Add(const std::string& key, const std::vector<std::string>& values);
  JsonObject& Add(const std::string& key, const std::vector<JsonObject>& values);
  /// A whole number; std::size_t, int and the like.
  template <typename Integer>
  JsonObject& AddCount(const std::string& key, Integer value) {
    return AddText(key, std::to_string(value));
  }

  /// "{...}" without a line end.
  std::string ToString() const { return "{" + members_ + "}"; }

 private:
  JsonObject& AddText(const std::string& key, const std::string& value);
  std::string members_;
};

}  // namespace hv::replay
