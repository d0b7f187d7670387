#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "hv_core/error.h"
#include "mapping_node.h"

namespace hv::loop {

/// Loop closing in the nodelet manager of the odometry, so that keyframes arrive without being
/// copied.
class MappingNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      node_ = std::make_unique<MappingNode>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const InputError& error) {
      NODELET_FATAL_STREAM("hv_loop_btc cannot start:\n" << error.what());
      throw;
    }
  }

  std::unique_ptr<MappingNode> node_;
};

}  // namespace hv::loop

PLUGINLIB_EXPORT_CLASS(hv::loop::MappingNodelet, nodelet::Nodelet)
