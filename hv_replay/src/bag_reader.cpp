#include "hv_replay/bag_reader.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>

#include "hv_core/error.h"
#include "hv_replay/console.h"
#include "recovered_bag.h"

namespace hv::replay {
namespace {

const char* const kPointsType = "sensor_msgs/PointCloud2";
const char* const kImuType = "sensor_msgs/Imu";

Time ToTime(const ros::Time& time) {
  return Time::FromNanoseconds(static_cast<std::int64_t>(time.toNSec()));
}

/// Opens a bag by its index; false when it has none, or a broken one.
bool Open(const std::string& path, rosbag::Bag& bag) {
  if (!std::filesystem::is_regular_file(path)) throw InputError(path + ": cannot be opened");
  if (!HasSoundIndex(path)) return false;
  try {
    bag.open(path, rosbag::bagmode::Read);
    return true;
  } catch (const rosbag::BagUnindexedException&) {
    return false;
  } catch (const rosbag::BagIOException&) {
    return false;
  } catch (const std::exception& error) {
    throw InputError(path + ": not a readable bag: " + error.what());
  }
}

std::string List(const std::vector<BagTopicInfo>& topics) {
  std::string text;
  for (const BagTopicInfo& topic : topics) {
    text += (text.empty() ? "" : ", ") + topic.name + " (" + topic.type + ")";
  }
  return text.empty() ? "none" : text;
}

std::string WithoutSlash(const std::string& name) {
  return !name.empty() && name[0] == '/' ? name.substr(1) : name;
}

/// Name as in the bag of the topic to read as `type`. Empty when none is named and none is there.
std::string FindTopic(const std::string& wanted, const std::string& type,
                      const std::vector<BagTopicInfo>& topics) {
  std::vector<BagTopicInfo> candidates;
  for (const BagTopicInfo& topic : topics) {
    const bool named = WithoutSlash(topic.name) == WithoutSlash(wanted);
    if (!wanted.empty() && named && topic.type != type) {
      throw InputError("topic " + topic.name + " is of type " + topic.type + ", " + type +
                       " is needed");
    }
    if (topic.type == type && (wanted.empty() || named)) candidates.push_back(topic);
  }
  if (candidates.size() > 1) {
    throw InputError("several topics of type " + type + ", name one: " + List(candidates));
  }
  if (!candidates.empty()) return candidates[0].name;
  if (wanted.empty()) return "";
  throw InputError("no topic " + wanted + " in the bag; topics are: " + List(topics));
}

std::string Counts(const BagReadResult& result) {
  return std::to_string(result.clouds) + " scans and " + std::to_string(result.imu_samples) +
         " IMU samples";
}

bool Handle(const sensor_msgs::PointCloud2& cloud, Time arrival, const BagHandlers& handlers,
            BagReadResult& result) {
  ++result.clouds;
  return !handlers.points || handlers.points({ViewOf(cloud), cloud.header.frame_id, arrival});
}

bool Handle(const sensor_msgs::Imu& imu, Time arrival, const BagHandlers& handlers,
            BagReadResult& result) {
  ++result.imu_samples;
  const auto& gyro = imu.angular_velocity;
  const auto& accel = imu.linear_acceleration;
  const ImuSample sample = {ToTime(imu.header.stamp), Eigen::Vector3d(gyro.x, gyro.y, gyro.z),
                            Eigen::Vector3d(accel.x, accel.y, accel.z)};
  return !handlers.imu || handlers.imu({sample, imu.header.frame_id, arrival});
}

/// Hands one message to its handler; returns false when reading shall end.
bool Dispatch(const rosbag::MessageInstance& message, const BagTopics& topics,
              const BagHandlers& handlers, BagReadResult& result) {
  const Time arrival = ToTime(message.getTime());
  try {
    if (message.getTopic() == topics.points) {
      return Handle(*message.instantiate<sensor_msgs::PointCloud2>(), arrival, handlers, result);
    }
    return Handle(*message.instantiate<sensor_msgs::Imu>(), arrival, handlers, result);
  } catch (const ros::serialization::StreamOverrunException&) {
    ++result.undecodable;
    return true;
  }
}

template <typename Message>
bool Deserialize(const RecoveredBag::Message& raw, Message& message) {
  ros::serialization::IStream stream(const_cast<std::uint8_t*>(raw.data),
                                     static_cast<std::uint32_t>(raw.size));
  try {
    ros::serialization::deserialize(stream, message);
    return true;
  } catch (const ros::serialization::StreamOverrunException&) {
    return false;
  }
}

/// As above, for a message of a bag without index.
bool Dispatch(const RecoveredBag::Message& message, const BagTopics& topics,
              const BagHandlers& handlers, BagReadResult& result) {
  sensor_msgs::PointCloud2 cloud;
  sensor_msgs::Imu imu;
  if (message.topic.name == topics.points && Deserialize(message, cloud)) {
    return Handle(cloud, message.arrival, handlers, result);
  }
  if (message.topic.name == topics.imu && Deserialize(message, imu)) {
    return Handle(imu, message.arrival, handlers, result);
  }
  const bool wanted = message.topic.name == topics.points || message.topic.name == topics.imu;
  if (wanted) ++result.undecodable;
  return true;
}

}  // namespace

struct BagReader::Bags {
  std::vector<std::unique_ptr<rosbag::Bag>> bags;
  rosbag::View view;
  std::string recovered_path;               ///< of the bag that was cut off
  std::unique_ptr<RecoveredBag> recovered;  ///< read in place of `bags`

  std::vector<BagTopicInfo> Topics();
  void Select(const BagTopics& topics);
};

std::vector<BagTopicInfo> BagReader::Bags::Topics() {
  std::map<std::string, BagTopicInfo> by_name;
  for (const std::unique_ptr<rosbag::Bag>& bag : bags) {
    rosbag::View all(*bag);
    for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
      BagTopicInfo& info = by_name[connection->topic];
      info.name = connection->topic;
      info.type = connection->datatype;
    }
    for (auto& [name, info] : by_name) {
      rosbag::View of_topic(*bag, rosbag::TopicQuery(name));
      info.count += of_topic.size();
    }
  }
  std::vector<BagTopicInfo> topics;
  for (const auto& [name, info] : by_name) topics.push_back(info);
  return topics;
}

void BagReader::Bags::Select(const BagTopics& topics) {
  std::vector<std::string> names = {topics.points};
  if (!topics.imu.empty()) names.push_back(topics.imu);
  for (const std::unique_ptr<rosbag::Bag>& bag : bags) {
    view.addQuery(*bag, rosbag::TopicQuery(names));
  }
}

BagReader::BagReader(const std::vector<std::string>& paths, const BagTopics& topics,
                     ImuNeed imu_need)
    : bags_(std::make_unique<Bags>()) {
  for (const std::string& path : paths) {
    bags_->bags.push_back(std::make_unique<rosbag::Bag>());
    if (Open(path, *bags_->bags.back())) continue;
    if (paths.size() > 1) {
      throw InputError(path + ": the bag was cut off and has no index; run 'rosbag reindex " +
                       path + "'");
    }
    bags_->recovered_path = path;
    bags_->recovered = std::make_unique<RecoveredBag>(path);
    if (bags_->recovered->topics().empty()) {
      throw InputError(path + ": the bag was cut off before its first whole chunk of messages");
    }
  }
  all_topics_ = bags_->recovered ? bags_->recovered->topics() : bags_->Topics();
  FindTopics(topics, imu_need);
  if (bags_->recovered) return;
  bags_->Select(topics_);
  if (bags_->view.size() == 0) throw InputError("no messages on " + topics_.points);
}

void BagReader::FindTopics(const BagTopics& topics, ImuNeed imu_need) {
  topics_.points = FindTopic(topics.points, kPointsType, all_topics_);
  if (topics_.points.empty()) {
    throw InputError(std::string("no ") + kPointsType +
                     " in the bag; topics are: " + List(all_topics_));
  }
  if (imu_need != ImuNeed::kIgnored) topics_.imu = FindTopic(topics.imu, kImuType, all_topics_);
  if (imu_need == ImuNeed::kRequired && topics_.imu.empty()) {
    throw InputError(std::string("no ") + kImuType +
                     " in the bag; topics are: " + List(all_topics_));
  }
}

BagReader::~BagReader() = default;

Time BagReader::begin() const {
  return bags_->recovered ? bags_->recovered->begin() : ToTime(bags_->view.getBeginTime());
}

Time BagReader::end() const {
  return bags_->recovered ? bags_->recovered->end() : ToTime(bags_->view.getEndTime());
}

BagReadResult BagReader::Read(const BagHandlers& handlers, const std::string& label) {
  BagReadResult result;
  ProgressLine progress(label);
  const double duration = std::max(end() - begin(), 1e-9);
  const auto note_progress = [&](Time arrival) {
    progress.Update((arrival - begin()) / duration, std::to_string(result.clouds) + " scans");
  };
  const auto handle = [&](const auto& message, Time arrival) {
    note_progress(arrival);
    return Dispatch(message, topics_, handlers, result);
  };
  try {
    if (bags_->recovered) {
      bags_->recovered->ForEach(
          [&](const RecoveredBag::Message& message) { return handle(message, message.arrival); });
      result.error = bags_->recovered_path + ": the bag was cut off after " + Counts(result) +
                     " ('rosbag reindex' repairs its index)";
      return result;
    }
    for (const rosbag::MessageInstance& message : bags_->view) {
      if (!handle(message, ToTime(message.getTime()))) break;
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    result.error = "the bag is damaged after " + Counts(result) + ": " + error.what();
  }
  return result;
}

}  // namespace hv::replay
