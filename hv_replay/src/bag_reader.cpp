#include "hv_replay/bag_reader.h"

#include <algorithm>
#include <map>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>

#include "hv_core/error.h"
#include "hv_replay/console.h"

namespace hv::replay {
namespace {

const char* const kPointsType = "sensor_msgs/PointCloud2";
const char* const kImuType = "sensor_msgs/Imu";

Time ToTime(const ros::Time& time) {
  return Time::FromNanoseconds(static_cast<std::int64_t>(time.toNSec()));
}

void Open(const std::string& path, rosbag::Bag& bag) {
  try {
    bag.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(path + ": the bag has no index (recording was cut off); run 'rosbag reindex " +
                     path + "'");
  } catch (const rosbag::BagIOException& error) {
    throw InputError(path + ": cannot be opened, or is truncated (then run 'rosbag reindex " +
                     path + "'): " + error.what());
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

/// Hands one message to its handler; returns false when reading shall end.
bool Dispatch(const rosbag::MessageInstance& message, const BagTopics& topics,
              const BagHandlers& handlers, BagReadResult& result) {
  try {
    if (message.getTopic() == topics.points) {
      const auto cloud = message.instantiate<sensor_msgs::PointCloud2>();
      ++result.clouds;
      return !handlers.points || handlers.points({ViewOf(*cloud), cloud->header.frame_id,
                                                  ToTime(message.getTime())});
    }
    const auto imu = message.instantiate<sensor_msgs::Imu>();
    ++result.imu_samples;
    const auto& gyro = imu->angular_velocity;
    const auto& accel = imu->linear_acceleration;
    const ImuSample sample = {ToTime(imu->header.stamp), Eigen::Vector3d(gyro.x, gyro.y, gyro.z),
                              Eigen::Vector3d(accel.x, accel.y, accel.z)};
    return !handlers.imu || handlers.imu({sample, imu->header.frame_id, ToTime(message.getTime())});
  } catch (const ros::serialization::StreamOverrunException&) {
    ++result.undecodable;
    return true;
  }
}

}  // namespace

struct BagReader::Bags {
  std::vector<std::unique_ptr<rosbag::Bag>> bags;
  rosbag::View view;

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
    Open(path, *bags_->bags.back());
  }
  all_topics_ = bags_->Topics();
  topics_.points = FindTopic(topics.points, kPointsType, all_topics_);
  if (topics_.points.empty()) {
    throw InputError(std::string("no ") + kPointsType + " in the bag; topics are: " +
                     List(all_topics_));
  }
  if (imu_need != ImuNeed::kIgnored) topics_.imu = FindTopic(topics.imu, kImuType, all_topics_);
  if (imu_need == ImuNeed::kRequired && topics_.imu.empty()) {
    throw InputError(std::string("no ") + kImuType + " in the bag; topics are: " +
                     List(all_topics_));
  }
  bags_->Select(topics_);
  if (bags_->view.size() == 0) throw InputError("no messages on " + topics_.points);
}

BagReader::~BagReader() = default;

Time BagReader::begin() const { return ToTime(bags_->view.getBeginTime()); }
Time BagReader::end() const { return ToTime(bags_->view.getEndTime()); }

BagReadResult BagReader::Read(const BagHandlers& handlers, const std::string& label) {
  BagReadResult result;
  ProgressLine progress(label);
  const double duration = std::max(end() - begin(), 1e-9);
  try {
    for (const rosbag::MessageInstance& message : bags_->view) {
      if (!Dispatch(message, topics_, handlers, result)) break;
      progress.Update((ToTime(message.getTime()) - begin()) / duration,
                      std::to_string(result.clouds) + " scans");
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    result.error = "the bag is damaged after " + std::to_string(result.clouds) + " scans and " +
                   std::to_string(result.imu_samples) + " IMU samples: " + error.what();
  }
  return result;
}

}  // namespace hv::replay
