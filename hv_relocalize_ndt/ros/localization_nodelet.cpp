#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "hv_core/error.h"
#include "localization_node.h"

namespace hv::relocalize {

/// Localisation in the nodelet manager of the odometry, so that scans arrive without being copied.
class LocalizationNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      node_ = std::make_unique<LocalizationNode>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const InputError& error) {
      NODELET_FATAL_STREAM("hv_relocalize_ndt cannot start:\n" << error.what());
      throw;
    }
  }

  std::unique_ptr<LocalizationNode> node_;
};

}  // namespace hv::relocalize

PLUGINLIB_EXPORT_CLASS(hv::relocalize::LocalizationNodelet, nodelet::Nodelet)
