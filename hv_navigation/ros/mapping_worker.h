#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <ros/node_handle.h>
#include <tf2_ros/buffer.h>

#include "frames.h"
#include "grid_publisher.h"
#include "hv_navigation/navigation_config.h"
#include "hv_navigation/surroundings.h"
#include "hv_ros/tracked_scan_message.h"
#include "odometry_buffer.h"
#include "sensor_queue.h"

namespace hv::navigation {

/// What became of the sensors' messages.
struct MappingCounters {
  std::size_t scans = 0;
  std::size_t scans_without_points = 0;
  std::size_t scans_unusable = 0;
  std::size_t images = 0;
  std::size_t images_unusable = 0;
  std::size_t images_without_pose = 0;  ///< neither odometry nor tf tells where the camera was
  std::size_t place_jumps = 0;
  std::size_t nodes = 0;  ///< of the octree
  std::size_t cells_left_out = 0;
  double scan_ms = 0.0;  ///< that the last scan took, grids included
  double longest_scan_ms = 0.0;
  double image_ms = 0.0;
  std::string last_error;
  SensorQueue::Counters queue;
};

/// Maps in a thread of its own what the sensors see, and sends the grids. Thread-safe.
class MappingWorker {
 public:
  /// `transforms` and `odometry` must outlive this object.
  MappingWorker(ros::NodeHandle nh, const NavigationConfig& config,
                std::optional<OccupancyGrid> prior, const tf2_ros::Buffer& transforms,
                const OdometryBuffer& odometry);
  ~MappingWorker();

  SensorQueue& queue() { return queue_; }

  /// The newest grids.
  SurroundingsView view() const;

  /// The obstacles around the robot are forgotten before the next scan.
  void ForgetObstacles() { forget_ = true; }
  /// But for what is so near that it would not be seen again.
  void LookAgain() { look_again_ = true; }
  /// The same for those in the map that the saved map does not hold.
  void ForgetAdditions() { forget_additions_ = true; }

  MappingCounters counters() const;

  /// Writes `grid.pgm`, `grid.yaml` and `occupancy.bt`. Throws InputError.
  void Save(const std::string& folder) const;

 private:
  void Run();
  void Handle(const SensorInput& input);
  void ForgetWhatIsAsked();
  void TakeScan(const hv_msgs::TrackedScan& message);
  void AddScan(const DecodedTrackedScan& scan);
  void TakeImage(const sensor_msgs::Image& message, const sensor_msgs::CameraInfo& camera);
  void ForgetWhatIsWrong(const TrackedScanHeader& scan, const std::optional<Pose>& T_map_odom);
  void Refuse(std::size_t MappingCounters::*counter, const std::string& error);

  const NavigationConfig config_;
  const tf2_ros::Buffer& transforms_;
  const OdometryBuffer& odometry_;
  SensorQueue queue_;
  GridPublisher publisher_;               // worker only
  PlaceJumps jumps_;                      // worker only
  std::optional<std::uint32_t> segment_;  // worker only
  std::optional<Time> last_scan_;         // worker only
  std::atomic<bool> forget_{false};
  std::atomic<bool> look_again_{false};
  std::atomic<bool> forget_additions_{false};

  mutable std::mutex mapping_mutex_;
  Surroundings surroundings_;  // guarded by mapping_mutex_; written by the worker only

  mutable std::mutex mutex_;  // guards what follows
  SurroundingsView view_;
  MappingCounters counters_;

  std::thread worker_;  // last: uses all of the above
};

}  // namespace hv::navigation
