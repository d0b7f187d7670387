#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "hv_explore_sac/train/labels.h"
#include "number_bytes.h"

namespace hv::explore {
namespace {

constexpr std::string_view kMagic = "hv_labels 1\n";
constexpr std::size_t kSumSize = 64;

/// The part after magic and sum, which must be right.
std::string_view Body(std::string_view bytes, const std::string& path) {
  if (bytes.substr(0, kMagic.size()) != kMagic) throw InputError(path + ": not a file of labels");
  bytes.remove_prefix(kMagic.size());
  const std::string_view sum = bytes.substr(0, kSumSize);
  bytes.remove_prefix(sum.size());
  if (Sha256(bytes) != sum) throw InputError(path + ": damaged, its SHA-256 does not fit");
  return bytes;
}

}  // namespace

void WriteLabels(const std::vector<LabelledState>& labels, const std::string& path) {
  std::string bytes;
  nn::AppendNumber(static_cast<std::uint64_t>(labels.size()), bytes);
  for (const LabelledState& label : labels) {
    label.state.AppendTo(bytes);
    const std::vector<float> returns(label.returns.data(),
                                     label.returns.data() + label.returns.size());
    nn::AppendNumbers(returns, bytes);
  }
  WriteFile(path, {kMagic, Sha256(bytes), bytes});
}

std::vector<LabelledState> ReadLabels(const std::string& path) {
  const std::string file = ReadFile(path);
  std::string_view bytes = Body(file, path);
  std::uint64_t count = 0;
  nn::TakeNumber(bytes, count);
  std::vector<LabelledState> labels;
  for (std::uint64_t i = 0; i < count; ++i) {
    LabelledState label{nn::PackedGraph::TakeFrom(bytes), {}};
    std::vector<float> returns;
    nn::TakeNumbers(bytes, returns);
    label.returns = Eigen::Map<const Eigen::VectorXf>(returns.data(),
                                                      static_cast<Eigen::Index>(returns.size()));
    labels.push_back(std::move(label));
  }
  return labels;
}

}  // namespace hv::explore
