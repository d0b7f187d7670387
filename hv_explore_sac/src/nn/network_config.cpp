#include "hv_explore_sac/nn/network_config.h"

namespace hv::explore::nn {

void NetworkConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("width", width, "numbers that describe a node within the network");
  visitor.Field("heads", heads, "of attention; they share the width");
  visitor.Field("feed_forward", feed_forward, "hidden units of the feed-forward part of a layer");
  visitor.Field("encoder_layers", encoder_layers, "of attention over the viewpoint graph");
  visitor.Field("pyramid_levels", pyramid_levels, "coarser views of the graph, 0 for none");
  visitor.Field("memory", memory, "state of the LSTM over the nodes visited last, 0 for none");
}

void NetworkConfig::Validate(ConfigProblems& problems) const {
  problems.Require(width > 0 && width <= 1024, "width", "must be within 1 and 1024");
  problems.Require(heads > 0 && heads <= width && width % heads == 0, "heads",
                   "must divide the width");
  problems.Require(feed_forward > 0 && feed_forward <= 4096, "feed_forward",
                   "must be within 1 and 4096");
  problems.Require(encoder_layers >= 0 && encoder_layers <= 24, "encoder_layers",
                   "must be within 0 and 24");
  problems.Require(pyramid_levels >= 0 && pyramid_levels <= 8, "pyramid_levels",
                   "must be within 0 and 8");
  problems.Require(memory >= 0 && memory <= 1024, "memory", "must be within 0 and 1024");
}

}  // namespace hv::explore::nn
