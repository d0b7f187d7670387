#pragma once

#include <string>
#include <vector>

namespace hv::explore {

/// How far a training was at one moment.
struct CurvePoint {
  int round = 0;
  int updates = 0;      ///< of the policy, over all rounds
  int states = 0;       ///< labelled, that it learns from
  double loss = 0.0;    ///< mean since the point before
  double gain = 0.0;    ///< of its choices in states kept aside over `utility`'s [cells]
  double travel = 0.0;  ///< on the maps for validation, NaN where it was not tried [cells]
  double share = 0.0;   ///< of that in the travel of `utility`, NaN likewise
};

/// As CSV.
void WriteCurve(const std::vector<CurvePoint>& points, const std::string& path);
/// Throws InputError, naming the line.
std::vector<CurvePoint> ReadCurve(const std::string& path);

}  // namespace hv::explore
