#include "hv_relocalize_ndt/robust_mixture.h"

#include <cmath>

namespace hv::relocalize {

RobustMixture RobustMixture::For(double resolution_m, double outlier_share) {
  const double c1 = 10.0 * (1.0 - outlier_share);
  const double c2 = outlier_share / (resolution_m * resolution_m * resolution_m);
  RobustMixture mixture;
  mixture.d3 = -std::log(c2);
  mixture.d1 = -std::log(c1 + c2) - mixture.d3;
  const double at_one_sigma = -std::log(c1 * std::exp(-0.5) + c2) - mixture.d3;
  mixture.d2 = -2.0 * std::log(at_one_sigma / mixture.d1);
  return mixture;
}

}  // namespace hv::relocalize
