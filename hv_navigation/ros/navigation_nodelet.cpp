#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "hv_core/error.h"
#include "navigation_node.h"

namespace hv::navigation {

/// Navigation in the nodelet manager of the odometry, so that scans arrive without being copied.
class NavigationNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      node_ = std::make_unique<NavigationNode>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const InputError& error) {
      NODELET_FATAL_STREAM("hv_navigation cannot start:\n" << error.what());
      throw;
    }
  }

  std::unique_ptr<NavigationNode> node_;
};

}  // namespace hv::navigation

PLUGINLIB_EXPORT_CLASS(hv::navigation::NavigationNodelet, nodelet::Nodelet)
