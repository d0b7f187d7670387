#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hv_core/imu_sample.h"
#include "hv_core/point_cloud_decoder.h"
#include "hv_core/time.h"

namespace hv::replay {

/// Which topics to read. An empty name means the only topic of the right type in the bags.
struct BagTopics {
  std::string points;
  std::string imu;
};

/// One topic as found in the bags.
struct BagTopicInfo {
  std::string name;
  std::string type;  ///< e.g. "sensor_msgs/Imu"
  std::size_t count = 0;
};

struct BagCloud {
  PointCloudView view;  ///< valid during the callback only
  std::string frame_id;
  Time arrival;  ///< when it was recorded
};

struct BagImu {
  ImuSample sample;  ///< in the units of the message
  std::string frame_id;
  Time arrival;
};

/// Receives messages; returning false ends the reading.
struct BagHandlers {
  std::function<bool(const BagCloud&)> points;
  std::function<bool(const BagImu&)> imu;
};

struct BagReadResult {
  std::size_t clouds = 0;
  std::size_t imu_samples = 0;
  std::size_t undecodable = 0;  ///< messages whose bytes contradict their type
  std::string error;  ///< not empty: a bag is damaged or cut off and reading ended there, one line
};

enum class ImuNeed { kRequired, kOptional, kIgnored };

/// Reads point clouds and IMU samples of one or several bags in order of arrival, as if the bags
/// were one. A single bag that was cut off is read as far as it goes. Not thread-safe.
class BagReader {
 public:
  /// Opens the bags and finds the topics. Throws InputError, naming bag and remedy, when a bag
  /// cannot be opened, when one of several is cut off, or when a topic is missing, ambiguous or of
  /// another type (listing the topics that are there).
  BagReader(const std::vector<std::string>& paths, const BagTopics& topics, ImuNeed imu_need);
  ~BagReader();

  /// The topics that will be read; `imu` is empty when there is none.
  const BagTopics& topics() const { return topics_; }
  /// Every topic in the bags, sorted by name.
  const std::vector<BagTopicInfo>& all_topics() const { return all_topics_; }
  /// Arrival of the first and the last message to be read.
  Time begin() const;
  Time end() const;

  /// Hands every message to its handler, with progress labelled `label` on a terminal. A damaged
  /// bag ends the reading and is told in the result; what was read before stays.
  BagReadResult Read(const BagHandlers& handlers, const std::string& label);

 private:
  struct Bags;

  void FindTopics(const BagTopics& topics, ImuNeed imu_need);

  std::unique_ptr<Bags> bags_;
  std::vector<BagTopicInfo> all_topics_;
  BagTopics topics_;
};

}  // namespace hv::replay
