#pragma once

#include <map>
#include <string>

#include "hv_explore_sac/nn/adam.h"
#include "hv_explore_sac/nn/parameters.h"

namespace hv::explore::nn {

/// Named matrices and numbers in one file: the weights that ship, or all that a training needs to
/// go on. The file carries a format version, names and shapes, and a SHA-256.
class Checkpoint {
 public:
  /// Free text, by custom the effective configuration.
  std::string text;

  /// Adds each block of `flat` as "<prefix>.<name>".
  void Put(const std::string& prefix, const ParameterLayout& layout, const Eigen::VectorXf& flat);
  void Put(const std::string& prefix, const ParameterLayout& layout, const Adam::State& state);
  void PutNumber(const std::string& name, double value) { numbers_[name] = value; }

  /// Throws InputError that names what is missing or has another shape.
  Eigen::VectorXf Parameters(const std::string& prefix, const ParameterLayout& layout) const;
  Adam::State AdamState(const std::string& prefix, const ParameterLayout& layout) const;
  double Number(const std::string& name) const;
  bool HasNumber(const std::string& name) const { return numbers_.count(name) > 0; }

  /// Written beside `path` and renamed, so that an old file stays whole until the new one is.
  void Write(const std::string& path) const;
  /// Throws InputError, naming the file and what is wrong with it.
  static Checkpoint Read(const std::string& path);

  std::string Serialize() const;
  static Checkpoint Parse(const std::string& bytes, const std::string& source);

 private:
  std::string source_ = "checkpoint";
  std::map<std::string, Matrix<float>> matrices_;
  std::map<std::string, double> numbers_;
};

}  // namespace hv::explore::nn
