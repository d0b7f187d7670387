#pragma once

#include "hv_core/config.h"

namespace hv::explore::nn {

/// The size of a network (paper, section 3.3.4 and Fig. 5).
struct NetworkConfig {
  int width = 64;
  int heads = 4;
  int feed_forward = 128;
  int encoder_layers = 6;
  int pyramid_levels = 2;
  int memory = 64;

  void Describe(ConfigVisitor& visitor);
  void Validate(ConfigProblems& problems) const;
};

}  // namespace hv::explore::nn
