#include "hv_core/config.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <system_error>

#include <yaml-cpp/yaml.h>

#include "hv_core/one_line.h"

namespace hv {

void ConfigProblems::Require(bool condition, const std::string& key, const std::string& what) {
  if (!condition) lines_.push_back(key + ": " + what);
}

namespace {

std::string Join(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + OneLine(line);
  return text;
}

/// Levenshtein distance.
std::size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitute = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
    }
  }
  return row[b.size()];
}

std::string Nearest(const std::string& key, const std::vector<std::string>& known) {
  return *std::min_element(known.begin(), known.end(),
                           [&key](const std::string& a, const std::string& b) {
                             return EditDistance(key, a) < EditDistance(key, b);
                           });
}

/// Reads all of `text` as a number of type T; false when anything else is in it.
template <typename T>
bool ParseNumber(const std::string& text, T& value) {
  const char* first = text.data();
  const char* last = first + text.size();
  if (first != last && *first == '+') ++first;
  T parsed{};
  const auto [end, error] = std::from_chars(first, last, parsed);
  if (error != std::errc() || end != last) return false;
  value = parsed;
  return true;
}

/// A scalar that was written without quotes.
bool IsPlain(const YAML::Node& node) { return node.IsScalar() && node.Tag() != "!"; }

bool Convert(const YAML::Node& node, bool& value) {
  const std::string text = IsPlain(node) ? node.Scalar() : "";
  if (text != "true" && text != "false") return false;
  value = text == "true";
  return true;
}

bool Convert(const YAML::Node& node, int& value) {
  return IsPlain(node) && ParseNumber(node.Scalar(), value);
}

bool Convert(const YAML::Node& node, double& value) {
  double parsed = 0.0;
  if (!IsPlain(node) || !ParseNumber(node.Scalar(), parsed) || !std::isfinite(parsed)) return false;
  value = parsed;
  return true;
}

bool Convert(const YAML::Node& node, std::string& value) {
  if (!node.IsScalar()) return false;
  value = node.Scalar();
  return true;
}

bool Convert(const YAML::Node& node, std::vector<double>& value) {
  if (!node.IsSequence()) return false;
  std::vector<double> parsed(node.size());
  for (std::size_t i = 0; i < node.size(); ++i) {
    if (!Convert(node[i], parsed[i])) return false;
  }
  value = std::move(parsed);
  return true;
}

const char* TypeName(bool) { return "true or false"; }
const char* TypeName(int) { return "a whole number"; }
const char* TypeName(double) { return "a finite number"; }
const char* TypeName(const std::string&) { return "a text"; }
const char* TypeName(const std::vector<double>&) { return "a list of finite numbers"; }

/// Fills fields from one YAML mapping and notes what is wrong with it.
class Reader : public ConfigVisitor {
 public:
  Reader(const YAML::Node& node, std::string source, std::string prefix,
         std::vector<std::string>& problems)
      : node_(node), source_(std::move(source)), prefix_(std::move(prefix)), problems_(problems) {
    is_map_ = node_.IsMap();
    if (!is_map_ && !node_.IsNull()) Complain(node_, "", "must be a mapping of keys to values");
  }

  void Field(const char* name, bool& value, const char*) override { Fill(name, value); }
  void Field(const char* name, int& value, const char*) override { Fill(name, value); }
  void Field(const char* name, double& value, const char*) override { Fill(name, value); }
  void Field(const char* name, std::string& value, const char*) override { Fill(name, value); }
  void Field(const char* name, std::vector<double>& value, const char*) override {
    Fill(name, value);
  }

  void Foreign(const char* name) override { known_.emplace_back(name); }

  /// To be called after the last field.
  void ReportUnknownKeys() {
    if (!is_map_) return;
    std::vector<std::string> seen;
    for (const auto& entry : node_) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "(not a text)";
      if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
        const std::string hint =
            known_.empty() ? "" : "; nearest is '" + Nearest(key, known_) + "'";
        Complain(entry.first, key, "unknown key" + hint);
      } else if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
        Complain(entry.first, key, "given twice");
      }
      seen.push_back(key);
    }
  }

 protected:
  void Nested(const char* name, const char*, const Describer& describe) override {
    Reader reader(Find(name).value, source_, prefix_ + name + ".", problems_);
    describe(reader);
    reader.ReportUnknownKeys();
  }

 private:
  /// Both null when the key is absent.
  struct Entry {
    YAML::Node key;
    YAML::Node value;
  };

  Entry Find(const char* name) {
    known_.emplace_back(name);
    if (!is_map_) return {};
    for (const auto& entry : node_) {
      if (entry.first.IsScalar() && entry.first.Scalar() == name) {
        return {entry.first, entry.second};
      }
    }
    return {};
  }

  template <typename T>
  void Fill(const char* name, T& value) {
    const Entry found = Find(name);
    if (found.key.IsNull() || Convert(found.value, value)) return;
    Complain(found.key, name, std::string("must be ") + TypeName(value));
  }

  void Complain(const YAML::Node& node, const std::string& key, const std::string& what) {
    std::string where = source_;
    if (!node.Mark().is_null()) where += ":" + std::to_string(node.Mark().line + 1);
    std::string name = prefix_ + key;
    if (key.empty() && !name.empty()) name.pop_back();
    problems_.push_back(where + ": " + (name.empty() ? "" : name + ": ") + what);
  }

  const YAML::Node node_;
  const std::string source_;
  const std::string prefix_;
  std::vector<std::string>& problems_;
  std::vector<std::string> known_;
  bool is_map_ = false;
};

std::string Format(bool value) { return value ? "true" : "false"; }
std::string Format(int value) { return std::to_string(value); }

/// Shortest decimal that reads back as the same number.
std::string Format(double value) {
  char text[40];
  const auto result = std::to_chars(text, text + sizeof(text), value);
  return std::string(text, result.ptr);
}

std::string Format(const std::string& value) {
  YAML::Emitter emitter;
  emitter << value;
  return emitter.c_str();
}

std::string Format(const std::vector<double>& value) {
  std::string text;
  for (const double number : value) text += (text.empty() ? "" : ", ") + Format(number);
  return "[" + text + "]";
}

/// Writes nested mappings, two spaces a level.
class Writer : public ConfigVisitor {
 public:
  explicit Writer(std::string indent = "") : indent_(std::move(indent)) {}
  const std::string& text() const { return text_; }

  void Field(const char* name, bool& value, const char*) override { Add(name, value); }
  void Field(const char* name, int& value, const char*) override { Add(name, value); }
  void Field(const char* name, double& value, const char*) override { Add(name, value); }
  void Field(const char* name, std::string& value, const char*) override { Add(name, value); }
  void Field(const char* name, std::vector<double>& value, const char*) override {
    Add(name, value);
  }

 protected:
  void Nested(const char* name, const char*, const Describer& describe) override {
    Writer nested(indent_ + "  ");
    describe(nested);
    text_ += indent_ + name + ":\n" + nested.text();
  }

 private:
  template <typename T>
  void Add(const char* name, const T& value) {
    text_ += indent_ + name + ": " + Format(value) + "\n";
  }

  const std::string indent_;
  std::string text_;
};

std::string EscapeCell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

/// Writes rows of a Markdown table, keys with the path of their sections.
class TableWriter : public ConfigVisitor {
 public:
  explicit TableWriter(std::string prefix = "") : prefix_(std::move(prefix)) {}
  const std::string& rows() const { return rows_; }

  void Field(const char* name, bool& value, const char* text) override { Add(name, value, text); }
  void Field(const char* name, int& value, const char* text) override { Add(name, value, text); }
  void Field(const char* name, double& value, const char* text) override { Add(name, value, text); }
  void Field(const char* name, std::string& value, const char* text) override {
    Add(name, value, text);
  }
  void Field(const char* name, std::vector<double>& value, const char* text) override {
    Add(name, value, text);
  }

 protected:
  void Nested(const char* name, const char* text, const Describer& describe) override {
    rows_ += "| **" + prefix_ + name + "** | | " + EscapeCell(text) + " |\n";
    TableWriter nested(prefix_ + name + ".");
    describe(nested);
    rows_ += nested.rows();
  }

 private:
  template <typename T>
  void Add(const char* name, const T& value, const char* text) {
    rows_ += "| `" + prefix_ + name + "` | `" + EscapeCell(Format(value)) + "` | " +
             EscapeCell(text) + " |\n";
  }

  const std::string prefix_;
  std::string rows_;
};

std::string SyntaxError(const std::string& source, const YAML::Exception& error) {
  const std::string line = error.mark.is_null() ? ""
                                                : ":" + std::to_string(error.mark.line + 1) + ":" +
                                                      std::to_string(error.mark.column + 1);
  return OneLine(source + line + ": not valid YAML: " + error.msg);
}

}  // namespace

namespace config_detail {

void Read(const YAML::Node& node, const std::string& source,
          const std::function<void(ConfigVisitor&)>& describe,
          const std::function<void(ConfigProblems&)>& validate) {
  std::vector<std::string> problems;
  Reader reader(node.IsDefined() ? node : YAML::Node(), source, "", problems);
  describe(reader);
  reader.ReportUnknownKeys();
  ConfigProblems invalid;
  validate(invalid);
  for (const std::string& line : invalid.lines()) problems.push_back(source + ": " + line);
  if (!problems.empty()) throw InputError(Join(problems));
}

std::string Write(const std::function<void(ConfigVisitor&)>& describe) {
  Writer writer;
  describe(writer);
  return writer.text();
}

std::string Table(const std::function<void(ConfigVisitor&)>& describe) {
  TableWriter writer;
  describe(writer);
  return "| key | default | meaning |\n|---|---|---|\n" + writer.rows();
}

}  // namespace config_detail

YAML::Node LoadYamlFile(const std::string& path) {
  try {
    return YAML::LoadFile(path);
  } catch (const YAML::BadFile&) {
    throw InputError(path + ": cannot be opened");
  } catch (const YAML::Exception& error) {
    throw InputError(SyntaxError(path, error));
  }
}

YAML::Node ParseYaml(const std::string& text, const std::string& source) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError(SyntaxError(source, error));
  }
}

}  // namespace hv
