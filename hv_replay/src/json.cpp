#include "hv_replay/json.h"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace hv::replay {
namespace {

std::string Quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) {
      quoted += c;
    } else {
      char escape[8];
      std::snprintf(escape, sizeof(escape), "\\u%04x", static_cast<unsigned>(c));
      quoted += escape;
    }
  }
  return quoted + "\"";
}

std::string Number(double value) {
  if (!std::isfinite(value)) return "null";
  char text[40];
  return std::string(text, std::to_chars(text, text + sizeof(text), value).ptr);
}

template <typename T, typename Format>
std::string List(const std::vector<T>& values, Format format) {
  std::string text;
  for (const T& value : values) text += (text.empty() ? "" : ", ") + format(value);
  return "[" + text + "]";
}

}  // namespace

JsonObject& JsonObject::Add(const std::string& key, double value) {
  return AddText(key, Number(value));
}

JsonObject& JsonObject::Add(const std::string& key, bool value) {
  return AddText(key, value ? "true" : "false");
}

JsonObject& JsonObject::Add(const std::string& key, const std::string& value) {
  return AddText(key, Quote(value));
}

JsonObject& JsonObject::Add(const std::string& key, const char* value) {
  return AddText(key, Quote(value));
}

JsonObject& JsonObject::Add(const std::string& key, const JsonObject& value) {
  return AddText(key, value.ToString());
}

JsonObject& JsonObject::Add(const std::string& key, const std::vector<double>& values) {
  return AddText(key, List(values, Number));
}

JsonObject& JsonObject::Add(const std::string& key, const std::vector<std::string>& values) {
  return AddText(key, List(values, Quote));
}

JsonObject& JsonObject::Add(const std::string& key, const std::vector<JsonObject>& values) {
  return AddText(key, List(values, [](const JsonObject& value) { return value.ToString(); }));
}

JsonObject& JsonObject::AddText(const std::string& key, const std::string& value) {
  members_ += (members_.empty() ? "" : ", ") + Quote(key) + ": " + value;
  return *this;
}

}  // namespace hv::replay
