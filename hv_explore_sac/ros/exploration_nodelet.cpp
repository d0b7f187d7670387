#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "exploration_node.h"
#include "hv_core/error.h"

namespace hv::explore {

/// Exploration in the nodelet manager of the navigation, so that maps arrive without being copied.
class ExplorationNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      node_ = std::make_unique<ExplorationNode>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const InputError& error) {
      NODELET_FATAL_STREAM("hv_explore_sac cannot start:\n" << error.what());
      throw;
    }
  }

  std::unique_ptr<ExplorationNode> node_;
};

}  // namespace hv::explore

PLUGINLIB_EXPORT_CLASS(hv::explore::ExplorationNodelet, nodelet::Nodelet)
