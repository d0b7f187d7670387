#include "hv_explore_sac/train/label_archive.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

namespace hv::explore {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMapsPerPart = 50;

void Append(std::vector<LabelledState> more, std::vector<LabelledState>& labels) {
  std::move(more.begin(), more.end(), std::back_inserter(labels));
}

}  // namespace

LabelArchive::LabelArchive(std::string folder, int rank)
    : LabelArchive(std::move(folder), "labels_" + std::to_string(rank) + "_") {}

LabelArchive::LabelArchive(std::string folder, std::string prefix)
    : folder_(std::move(folder)), prefix_(std::move(prefix)) {}

void LabelArchive::Clear() const {
  std::vector<fs::path> old;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    if (entry.path().filename().string().rfind(prefix_, 0) == 0) old.push_back(entry.path());
  }
  for (const fs::path& path : old) fs::remove(path);
}

std::vector<LabelledState> LabelArchive::Collect(const std::string& name, const MapSupply& maps,
                                                 const LabelInputs& inputs, std::uint64_t seed,
                                                 const Report& report) const {
  std::vector<LabelledState> labels;
  for (std::size_t begin = 0; begin < maps.size(); begin += kMapsPerPart) {
    const std::size_t end = std::min(begin + kMapsPerPart, maps.size());
    const std::string path = PartPath(name, begin / kMapsPerPart);
    if (fs::exists(path)) {
      Append(ReadLabels(path), labels);
      continue;
    }
    std::vector<LabelledState> made = LabelMaps(maps, begin, end, inputs, seed, [&](double share) {
      const double done = static_cast<double>(begin) + share * static_cast<double>(end - begin);
      report(done / static_cast<double>(maps.size()));
    });
    WriteLabels(made, path);
    Append(std::move(made), labels);
  }
  return labels;
}

void LabelArchive::TakeOver(const std::string& folder, const std::string& name,
                            std::size_t maps_there, std::size_t maps_here) const {
  const LabelArchive other(folder, prefix_);
  for (std::size_t part = 0;; ++part) {
    const std::size_t end = (part + 1) * kMapsPerPart;
    const std::string path = other.PartPath(name, part);
    if (!fs::exists(path) || std::min(end, maps_there) != std::min(end, maps_here)) return;
    fs::copy_file(path, PartPath(name, part), fs::copy_options::overwrite_existing);
  }
}

std::vector<LabelledState> LabelArchive::Read(const std::string& name) const {
  std::vector<LabelledState> labels;
  for (std::size_t part = 0; fs::exists(PartPath(name, part)); ++part) {
    Append(ReadLabels(PartPath(name, part)), labels);
  }
  return labels;
}

std::string LabelArchive::PartPath(const std::string& name, std::size_t part) const {
  return folder_ + "/" + prefix_ + name + "_" + std::to_string(part + 1) + ".bin";
}

}  // namespace hv::explore
