#include "topic_watch.h"

#include <algorithm>
#include <utility>

#include <ros/console.h>
#include <ros/master.h>

namespace hv::lio {
namespace {

constexpr double kPatience = 3.0;          // [s]
constexpr double kLongestSilence = 300.0;  // between two warnings [s]

}  // namespace

TopicWatch::TopicWatch(std::string topic, std::string type)
    : topic_(std::move(topic)),
      type_(std::move(type)),
      last_s_(ros::WallTime::now().toSec()),
      warn_after_s_(kPatience) {}

void TopicWatch::OnMessage() {
  last_s_ = ros::WallTime::now().toSec();
  ever_ = true;
}

void TopicWatch::Check() {
  const double silent = SilentSeconds();
  if (silent < kPatience) warn_after_s_ = kPatience;
  if (silent < warn_after_s_) return;
  ROS_WARN_STREAM(problem() << "; " << Alternatives());
  warn_after_s_ = silent + std::clamp(2.0 * silent, 5.0, kLongestSilence);
}

std::string TopicWatch::problem() const {
  const double silent = SilentSeconds();
  if (silent < kPatience) return "";
  return std::string(ever_ ? "no more" : "no") + " messages on " + topic_ + " (" + type_ +
         ") for " + std::to_string(static_cast<int>(silent)) + " s";
}

double TopicWatch::SilentSeconds() const { return ros::WallTime::now().toSec() - last_s_; }

std::string TopicWatch::Alternatives() const {
  ros::master::V_TopicInfo topics;
  if (!ros::master::getTopics(topics)) return "the ROS master does not answer";
  std::string names;
  for (const ros::master::TopicInfo& topic : topics) {
    if (topic.datatype == type_) names += " " + topic.name;
  }
  if (names.empty()) return "nobody publishes " + type_;
  return "published topics of that type:" + names;
}

}  // namespace hv::lio
