#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "hv_core/error.h"
#include "odometry_node.h"

namespace hv::lio {

/// The odometry in a nodelet manager, so that clouds arrive without being copied.
class OdometryNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      node_ = std::make_unique<OdometryNode>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const InputError& error) {
      NODELET_FATAL_STREAM("hv_lio cannot start:\n" << error.what());
      throw;
    }
  }

  std::unique_ptr<OdometryNode> node_;
};

}  // namespace hv::lio

PLUGINLIB_EXPORT_CLASS(hv::lio::OdometryNodelet, nodelet::Nodelet)
