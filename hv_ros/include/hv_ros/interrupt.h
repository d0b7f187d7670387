#pragma once

#include <csignal>

namespace hv {

/// Interrupts (SIGINT, SIGTERM) that end a node only when it is ready. Unlike the handler of ROS it
/// leaves topics open, so that last words get out: for nodes that have initialised ROS with
/// NoSigintHandler. To be made before any other thread.
class Interrupt {
 public:
  Interrupt();

  /// Returns after an interrupt, or when ROS has ended.
  void Wait() const;

 private:
  sigset_t signals_;
};

}  // namespace hv
