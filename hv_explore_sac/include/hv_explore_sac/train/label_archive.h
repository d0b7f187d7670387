#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hv_explore_sac/train/labels.h"

namespace hv::explore {

/// The labels that one rank makes in a training, kept on disk in parts, so that little is lost when
/// it is interrupted. Not thread-safe.
class LabelArchive {
 public:
  using Report = std::function<void(double share)>;

  LabelArchive(std::string folder, int rank);

  /// Removes what another training has left.
  void Clear() const;

  /// As LabelMaps(); parts that are there already are not made again. Throws InputError when one of
  /// these is damaged.
  std::vector<LabelledState> Collect(const std::string& name, const MapSupply& maps,
                                     const LabelInputs& inputs, std::uint64_t seed,
                                     const Report& report) const;

  /// Copies what the same rank of another training has made under this name of `maps_there` maps,
  /// as far as Collect() would make the same of `maps_here` maps that begin with the same ones.
  void TakeOver(const std::string& folder, const std::string& name, std::size_t maps_there,
                std::size_t maps_here) const;

  /// What Collect() has made under this name.
  std::vector<LabelledState> Read(const std::string& name) const;

 private:
  LabelArchive(std::string folder, std::string prefix);
  std::string PartPath(const std::string& name, std::size_t part) const;

  std::string folder_;
  std::string prefix_;  ///< of all names of files
};

}  // namespace hv::explore
