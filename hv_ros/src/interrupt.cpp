#include "hv_ros/interrupt.h"

#include <ctime>

#include <ros/init.h>

namespace hv {

Interrupt::Interrupt() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

void Interrupt::Wait() const {
  const timespec patience{0, 100'000'000};
  while (ros::ok() && sigtimedwait(&signals_, nullptr, &patience) < 0) {
  }
}

}  // namespace hv
