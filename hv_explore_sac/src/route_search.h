#pragma once

#include <random>
#include <vector>

#include "map_knowledge.h"

namespace hv::explore {

/// Looks for a short route through the true map from which all but `allowed` of the cells that are
/// looked at are seen, what is seen at every viewpoint on the way included. Not thread-safe.
class RouteSearch {
 public:
  RouteSearch(const MapKnowledge& knowledge, int allowed, unsigned seed)
      : knowledge_(knowledge), allowed_(allowed), random_(seed) {}

  /// Stops of a route from `start`, where `known` has been seen already; empty when nothing more is
  /// needed. `route` is a first guess, which may be empty; `trials` times a part of the
  /// best one is given up and found anew.
  std::vector<int> Plan(int start, const CellSet& known, std::vector<int> route, int trials);

 private:
  struct Value {
    double length;
    int missing;
  };
  Value Evaluate(const std::vector<int>& route);
  double Cost(const std::vector<int>& route);
  void Construct(std::vector<int>& route, double greed);
  std::vector<int> WithGap(std::vector<int> route);
  double Improve(std::vector<int>& route);
  bool DropStops(std::vector<int>& route, double& cost);
  bool MoveStops(std::vector<int>& route, double& cost);
  void Cover(const std::vector<int>& route, CellSet& cells) const;

  const MapKnowledge& knowledge_;
  int allowed_;
  std::mt19937 random_;
  int start_ = 0;
  CellSet known_;
  CellSet scratch_;
};

}  // namespace hv::explore
