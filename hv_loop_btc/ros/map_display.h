#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "display_cloud.h"
#include "hv_loop_btc/mapping_config.h"
#include "loop_engine.h"

namespace hv::loop {

/// Publishes what people look at: `map_path`, `loop_markers`, `map_cloud` and the 2-D grid `map`.
/// Each is latched, made only while somebody listens and only after something has changed, in a
/// thread of its own that never holds up loop closing. The grid is a whole MapBuilder run: after
/// one that took t seconds there is none for 4 t.
class MapDisplay {
 public:
  /// `engine` must outlive this object.
  MapDisplay(ros::NodeHandle nh, const MappingConfig& config, const LoopEngine& engine);
  ~MapDisplay();

  /// Ends the thread; a grid that is being built is given up.
  void Stop();

 private:
  /// One latched topic: what has been sent on it.
  struct Topic {
    ros::Publisher publisher;
    std::uint64_t sent_revision = 0;
    ros::WallTime next;  ///< not before

    bool Wants(std::uint64_t revision) const;
    void Sent(std::uint64_t revision, double pause_s);
  };

  void Run();
  bool WaitForNextRound();
  void PublishRound();
  void PublishPath(const LoopView& view);
  void PublishCloud(const LoopView& view);
  void PublishGrid(const LoopView& view);
  PointCloud Load(std::uint32_t id) const;

  const MappingConfig config_;
  const LoopEngine& engine_;
  Topic path_;
  Topic markers_;
  Topic cloud_topic_;
  Topic grid_;
  DisplayCloud cloud_;

  std::mutex mutex_;  // for wake_
  std::condition_variable wake_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace hv::loop
