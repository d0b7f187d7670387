#include "hv_explore_sac/nn/checkpoint.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "hv_core/binary_io.h"
#include "hv_core/error.h"
#include "hv_core/file_io.h"

namespace hv::explore::nn {
namespace {

constexpr char kMagic[8] = {'H', 'V', 'W', 'E', 'I', 'G', 'H', 'T'};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kSumBytes = 64;

std::string ShapeText(Index rows, Index cols) {
  return std::to_string(rows) + " x " + std::to_string(cols);
}

Matrix<float> GetMatrix(BinaryReader& reader) {
  const std::size_t rows = reader.Get<std::uint32_t>();
  const std::size_t cols = reader.Get<std::uint32_t>();
  // Both factors are below 2^32, so the product cannot overflow; either may still be absurd.
  constexpr std::size_t kMost = std::size_t{1} << 28U;
  if (std::max({rows, cols, rows * cols}) > kMost) reader.Fail("holds a matrix that is too large");
  const char* bytes = reader.Advance(rows * cols * sizeof(float));
  Matrix<float> matrix(static_cast<Index>(rows), static_cast<Index>(cols));
  if (matrix.size() == 0) return matrix;
  std::memcpy(matrix.data(), bytes, rows * cols * sizeof(float));
  if (!matrix.allFinite()) reader.Fail("holds a number that is not finite");
  return matrix;
}

/// The bytes ahead of the sum, after magic, version and sum were found right.
std::string Content(const std::string& bytes, const std::string& source) {
  BinaryReader header(bytes, source);
  if (std::memcmp(header.Advance(sizeof(kMagic)), kMagic, sizeof(kMagic)) != 0) {
    header.Fail("is no file of weights");
  }
  const auto version = header.Get<std::uint32_t>();
  if (version != kVersion) {
    header.Fail("has format version " + std::to_string(version) + ", this program reads " +
                std::to_string(kVersion));
  }
  header.Advance(kSumBytes);
  std::string content = bytes.substr(0, bytes.size() - kSumBytes);
  if (Sha256(content) != std::string_view(bytes).substr(content.size())) {
    header.Fail("does not agree with its checksum");
  }
  return content;
}

}  // namespace

void Checkpoint::Put(const std::string& prefix, const ParameterLayout& layout,
                     const Eigen::VectorXf& flat) {
  for (const ParameterLayout::Block& block : layout.blocks()) {
    matrices_[prefix + "." + block.name] = block.slot.In(flat.data()).matrix();
  }
}

void Checkpoint::Put(const std::string& prefix, const ParameterLayout& layout,
                     const Adam::State& state) {
  Put(prefix + ".mean", layout, state.mean);
  Put(prefix + ".square", layout, state.square);
  PutNumber(prefix + ".steps", static_cast<double>(state.steps));
}

Eigen::VectorXf Checkpoint::Parameters(const std::string& prefix,
                                       const ParameterLayout& layout) const {
  Eigen::VectorXf flat(layout.size());
  for (const ParameterLayout::Block& block : layout.blocks()) {
    const std::string name = prefix + "." + block.name;
    const auto found = matrices_.find(name);
    if (found == matrices_.end()) throw InputError(source_ + ": holds no '" + name + "'");
    const Matrix<float>& matrix = found->second;
    if (matrix.rows() != block.slot.rows || matrix.cols() != block.slot.cols) {
      throw InputError(source_ + ": '" + name + "' is " + ShapeText(matrix.rows(), matrix.cols()) +
                       ", the network needs " + ShapeText(block.slot.rows, block.slot.cols));
    }
    block.slot.In(flat.data()).matrix() = matrix;
  }
  return flat;
}

Adam::State Checkpoint::AdamState(const std::string& prefix, const ParameterLayout& layout) const {
  return {Parameters(prefix + ".mean", layout), Parameters(prefix + ".square", layout),
          static_cast<std::int64_t>(Number(prefix + ".steps"))};
}

double Checkpoint::Number(const std::string& name) const {
  const auto found = numbers_.find(name);
  if (found == numbers_.end()) throw InputError(source_ + ": holds no '" + name + "'");
  return found->second;
}

void Checkpoint::Write(const std::string& path) const { WriteFile(path, {Serialize()}); }

Checkpoint Checkpoint::Read(const std::string& path) { return Parse(ReadFile(path), path); }

std::string Checkpoint::Serialize() const {
  BinaryWriter writer;
  writer.PutRaw(kMagic, sizeof(kMagic));
  writer.Put(kVersion);
  writer.PutText(text);
  writer.PutSize(numbers_.size());
  for (const auto& [name, value] : numbers_) {
    writer.PutText(name);
    writer.Put(value);
  }
  writer.PutSize(matrices_.size());
  for (const auto& [name, matrix] : matrices_) {
    writer.PutText(name);
    writer.PutSize(static_cast<std::size_t>(matrix.rows()));
    writer.PutSize(static_cast<std::size_t>(matrix.cols()));
    writer.PutRaw(reinterpret_cast<const char*>(matrix.data()),
                  static_cast<std::size_t>(matrix.size()) * sizeof(float));
  }
  const std::string content = writer.Take();
  return content + Sha256(content);
}

Checkpoint Checkpoint::Parse(const std::string& bytes, const std::string& source) {
  const std::string content = Content(bytes, source);
  BinaryReader reader(content, source);
  reader.Advance(sizeof(kMagic) + sizeof(kVersion));
  Checkpoint checkpoint;
  checkpoint.source_ = source;
  checkpoint.text = reader.GetText();
  for (std::size_t left = reader.GetSize(4 + 8); left > 0; --left) {
    const std::string name = reader.GetText();
    const auto value = reader.Get<double>();
    if (!std::isfinite(value)) reader.Fail("holds a number that is not finite");
    checkpoint.numbers_[name] = value;
  }
  for (std::size_t left = reader.GetSize(4 + 8); left > 0; --left) {
    const std::string name = reader.GetText();
    checkpoint.matrices_[name] = GetMatrix(reader);
  }
  if (!reader.AtEnd()) reader.Fail("goes on behind its end");
  return checkpoint;
}

}  // namespace hv::explore::nn
