#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hv_core/trajectory.h"
#include "hv_sim/recording.h"

namespace hv::sim {

/// One kind of trouble that a recording can be given.
struct FaultKind {
  std::string name;
  std::string description;
  std::map<std::string, double> parameters;  ///< with their defaults
};

/// Everything ParseFault() knows, for help texts.
const std::vector<FaultKind>& FaultKinds();

struct Fault {
  std::string name;
  std::map<std::string, double> parameters;  ///< complete: defaults filled in
};

/// Parses `name` or `name:key=value,key=value`. Throws InputError naming an unknown fault, an
/// unknown parameter or a value that is not a number.
Fault ParseFault(const std::string& text);

/// Damages a stream of messages, in the order in which it is called. Deterministic for a seed; not
/// thread-safe.
class FaultInjector {
 public:
  FaultInjector(const std::vector<Fault>& faults, Time start, std::uint32_t seed);
  ~FaultInjector();

  /// Changes `message`; false when it is lost altogether.
  bool Apply(SensorMessage& message);

 private:
  struct Active;
  std::vector<std::unique_ptr<Active>> active_;
};

/// The truth of a stream that was damaged: a `kidnap` leaves out its stretch.
Trajectory TruthUnder(const std::vector<Fault>& faults, Time start, const Trajectory& truth);

/// Cuts the file to the share that a `truncated_bag` fault keeps, if `faults` has one. Throws
/// InputError when the file cannot be cut.
void TruncateIfAsked(const std::vector<Fault>& faults, const std::string& path);

}  // namespace hv::sim
