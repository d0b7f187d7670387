#pragma once

#include <atomic>
#include <string>

#include <ros/time.h>

namespace hv::lio {

/// Notices that an input topic is silent and says what could be meant instead. `OnMessage` may be
/// called from any thread; `Check` from one.
class TopicWatch {
 public:
  /// `topic` as resolved, `type` as in "sensor_msgs/Imu".
  TopicWatch(std::string topic, std::string type);

  void OnMessage();

  /// To be called about once a second. Logs a warning, again after growing pauses, while no message
  /// came for more than three seconds (wall time).
  void Check();

  /// One line while the topic is silent, else empty.
  std::string problem() const;

 private:
  double SilentSeconds() const;
  std::string Alternatives() const;

  const std::string topic_;
  const std::string type_;
  std::atomic<double> last_s_;  // wall time of the last message, or of the start
  std::atomic<bool> ever_{false};
  double warn_after_s_;
};

}  // namespace hv::lio
