#include "keyframe_queue.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include <ros/serialization.h>
#include <boost/make_shared.hpp>

namespace hv::loop {
namespace {

constexpr const char* kPrefix = "waiting-";

}  // namespace

KeyframeQueue::KeyframeQueue(std::string folder, std::size_t max_in_memory)
    : folder_(std::move(folder)), max_in_memory_(max_in_memory) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored)) {
    const std::string name = entry.path().filename();
    if (name.rfind(kPrefix, 0) == 0) std::filesystem::remove(entry.path(), ignored);
  }
}

KeyframeQueue::~KeyframeQueue() {
  for (const Entry& entry : entries_) {
    if (!entry.keyframe) std::remove(PathOf(entry.number).c_str());
  }
}

void KeyframeQueue::Push(const hv_msgs::KeyframeConstPtr& keyframe) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closed_) return;
    Entry entry{keyframe, next_number_++};
    if (entries_.size() >= max_in_memory_) {
      if (WriteFile(entry)) {
        entry.keyframe.reset();
        ++counters_.on_disk;
      } else {
        ++counters_.disk_errors;
      }
    }
    entries_.push_back(std::move(entry));
  }
  ready_.notify_one();
}

hv_msgs::KeyframeConstPtr KeyframeQueue::Pop() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    ready_.wait(lock, [this] { return closed_ || !entries_.empty(); });
    if (entries_.empty()) return nullptr;
    const Entry entry = std::move(entries_.front());
    entries_.pop_front();
    if (entry.keyframe) return entry.keyframe;
    --counters_.on_disk;
    if (const auto keyframe = ReadFile(entry.number)) return keyframe;
    ++counters_.lost;
  }
}

void KeyframeQueue::Close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
  }
  ready_.notify_all();
}

KeyframeQueue::Counters KeyframeQueue::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  Counters counters = counters_;
  counters.waiting = entries_.size();
  return counters;
}

std::string KeyframeQueue::PathOf(std::uint64_t number) const {
  return folder_ + "/" + kPrefix + std::to_string(number) + ".msg";
}

bool KeyframeQueue::WriteFile(const Entry& entry) const {
  const std::uint32_t size = ros::serialization::serializationLength(*entry.keyframe);
  std::vector<char> bytes(size);
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), size);
  ros::serialization::serialize(stream, *entry.keyframe);
  std::ofstream file(PathOf(entry.number), std::ios::binary);
  file.write(bytes.data(), size);
  file.close();
  if (file) return true;
  std::remove(PathOf(entry.number).c_str());
  return false;
}

hv_msgs::KeyframeConstPtr KeyframeQueue::ReadFile(std::uint64_t number) const {
  std::ifstream file(PathOf(number), std::ios::binary);
  std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::remove(PathOf(number).c_str());
  auto keyframe = boost::make_shared<hv_msgs::Keyframe>();
  try {
    ros::serialization::IStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                       static_cast<std::uint32_t>(bytes.size()));
    ros::serialization::deserialize(stream, *keyframe);
  } catch (const ros::serialization::StreamOverrunException&) {
    return nullptr;
  }
  return keyframe;
}

}  // namespace hv::loop
