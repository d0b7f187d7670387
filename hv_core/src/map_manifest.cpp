#include "map_manifest.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <yaml-cpp/yaml.h>

#include "fail.h"
#include "hv_core/config.h"
#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "point_fields.h"
#include "yaml_value.h"

namespace hv {
namespace {

constexpr const char* kSumKey = "manifest_sha256: ";

/// `text` as a YAML block that reads back as it is, except for characters YAML does not allow.
std::string Block(const std::string& text) {
  std::string block = "|2+\n  ";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') continue;
    block += c;
    if (c == '\n') block += "  ";
  }
  return block;
}

std::string Quoted(const std::string& text) {
  YAML::Emitter emitter;
  emitter << YAML::DoubleQuoted << text;
  return emitter.c_str();
}

/// The text without its last line, whose sum must match the rest.
std::string CheckSum(const std::string& text, const std::string& source) {
  const std::size_t line = text.rfind(kSumKey);
  if (line == std::string::npos || (line > 0 && text[line - 1] != '\n')) {
    Fail(source, "is cut short: its own checksum is missing");
  }
  std::string body = text.substr(0, line);
  if (text.substr(line) != kSumKey + Sha256(body) + "\n") {
    Fail(source, "does not match its own checksum: damaged or edited");
  }
  return body;
}

/// The version stands in the first line in every format.
int ReadVersion(const std::string& text, const std::string& source) {
  const std::string key = "format_version: ";
  std::size_t version = 0;
  const std::string line = text.substr(0, text.find('\n'));
  if (line.compare(0, key.size(), key) != 0 ||
      !ParseCount(std::string_view(line).substr(key.size()), version) || version > 1000000) {
    Fail(source, "does not start with the format_version: no map, or damaged");
  }
  return static_cast<int>(version);
}

/// Brings the content of an older manifest up to date, one version at a time. A new version adds a
/// case that turns the nodes of the version before into its own.
void Migrate(int version, YAML::Node& /*node*/, const std::string& source) {
  for (; version < kMapFormatVersion; ++version) {
    switch (version) {
      default:
        Fail(source, "format_version " + std::to_string(version) + " is not supported");
    }
  }
}

std::vector<MapFile> ReadFiles(const YAML::Node& list, const std::string& source) {
  if (!list.IsDefined() || !list.IsSequence()) Fail(source, "key 'files' is missing or no list");
  std::vector<MapFile> files;
  for (const YAML::Node& entry : list) {
    MapFile file;
    file.name = YamlValue<std::string>(entry, "name", source);
    file.size = YamlValue<std::size_t>(entry, "size", source);
    file.sha256 = YamlValue<std::string>(entry, "sha256", source);
    if (!IsMapFile(file.name)) Fail(source, "lists '" + file.name + "', which is no file of a map");
    files.push_back(std::move(file));
  }
  const auto by_name = [](const MapFile& a, const MapFile& b) { return a.name < b.name; };
  std::sort(files.begin(), files.end(), by_name);
  const auto same = [](const MapFile& a, const MapFile& b) { return a.name == b.name; };
  if (std::adjacent_find(files.begin(), files.end(), same) != files.end()) {
    Fail(source, "lists a file twice");
  }
  return files;
}

}  // namespace

std::string ManifestText(const MapManifest& manifest) {
  std::string text = "format_version: " + std::to_string(manifest.format_version) + "\n";
  text += "frame: " + Quoted(manifest.frame) + "\n";
  text += "keyframes: " + std::to_string(manifest.keyframes) + "\n";
  text += "loops: " + std::to_string(manifest.loops) + "\n";
  text += "cloud_points: " + std::to_string(manifest.cloud_points) + "\n";
  text += manifest.files.empty() ? "files: []\n" : "files:\n";
  for (const MapFile& file : manifest.files) {
    text += "  - {name: " + file.name + ", size: " + std::to_string(file.size) +
            ", sha256: " + file.sha256 + "}\n";
  }
  text += "configuration: " + Block(manifest.configuration) + "\n";
  return text + kSumKey + Sha256(text) + "\n";
}

MapManifest ParseManifest(const std::string& text, const std::string& source) {
  MapManifest manifest;
  const int version = ReadVersion(text, source);
  if (version > kMapFormatVersion) {
    Fail(source, "format_version " + std::to_string(version) + " is newer than " +
                     std::to_string(kMapFormatVersion) + ", the newest this program can read");
  }
  YAML::Node node = ParseYaml(CheckSum(text, source), source);
  if (!node.IsMap()) Fail(source, "is not a mapping");
  Migrate(version, node, source);
  manifest.frame = YamlValue<std::string>(node, "frame", source);
  manifest.keyframes = YamlValue<std::size_t>(node, "keyframes", source);
  manifest.loops = YamlValue<std::size_t>(node, "loops", source);
  manifest.cloud_points = YamlValue<std::size_t>(node, "cloud_points", source);
  manifest.configuration = YamlValue<std::string>(node, "configuration", source);
  // The block ends with the line break that separates it from the next key.
  if (!manifest.configuration.empty()) manifest.configuration.pop_back();
  manifest.files = ReadFiles(node["files"], source);
  return manifest;
}

bool IsMapFile(const std::string& name) {
  std::uint32_t id = 0;
  for (const char* known : {kManifestName, "poses.tum", "graph.g2o", "descriptors.bin", "cloud.pcd",
                            "grid.pgm", "grid.yaml", "occupancy.bt"}) {
    if (name == known) return true;
  }
  return ParseKeyframeName(name, id);
}

bool ParseKeyframeName(const std::string& name, std::uint32_t& id) {
  constexpr std::size_t kDigitsAt = 10;  // after "keyframes/"
  if (name.size() < kDigitsAt + 10) return false;
  const std::string_view digits = std::string_view(name).substr(kDigitsAt, name.size() - 14);
  std::size_t value = 0;
  if (!ParseCount(digits, value) || value > UINT32_MAX) return false;
  id = static_cast<std::uint32_t>(value);
  return name == KeyframeFileName(id);
}

std::string KeyframeFileName(std::uint32_t id) {
  char name[40];
  std::snprintf(name, sizeof(name), "keyframes/%06u.pcd", id);
  return name;
}

std::string OldMapPathOf(const std::string& path) {
  const std::filesystem::path target(path);
  return target.parent_path() / ("." + target.filename().string() + ".old");
}

}  // namespace hv
