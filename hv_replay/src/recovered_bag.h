#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hv_core/time.h"
#include "hv_replay/bag_reader.h"

namespace hv::replay {

/// False for a bag of format 2.0 whose index is missing or damaged, which rosbag must not be given:
/// it reads beyond its buffers then.
bool HasSoundIndex(const std::string& path);

/// Reads a bag (format 2.0) front to back without its index, as far as it is intact: for
/// recordings that were cut off. Only plain and lz4 chunks.
class RecoveredBag {
 public:
  struct Message {
    const BagTopicInfo& topic;  ///< its count is not set
    Time arrival;
    const std::uint8_t* data;
    std::size_t size;
  };
  using Handler = std::function<bool(const Message&)>;

  /// Looks through the whole file once. Throws InputError when it is not such a bag.
  explicit RecoveredBag(const std::string& path);

  const std::vector<BagTopicInfo>& topics() const { return topics_; }
  Time begin() const { return begin_; }
  Time end() const { return end_; }

  /// Hands every message to `handle`, chunk by chunk, in order of arrival within each, until it
  /// returns false or the bag ends.
  void ForEach(const Handler& handle) const;

 private:
  std::string path_;
  std::vector<BagTopicInfo> topics_;
  Time begin_, end_;
};

}  // namespace hv::replay
