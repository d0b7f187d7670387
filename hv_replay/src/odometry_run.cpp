#include "hv_replay/odometry_run.h"

#include <chrono>
#include <cstdio>
#include <utility>

namespace hv::replay {
namespace {

ImuNeed NeedOf(const lio::SystemConfig& config) {
  return config.odometry.use_imu ? ImuNeed::kRequired : ImuNeed::kIgnored;
}

}  // namespace

OdometryRun::OdometryRun(const lio::SystemConfig& config, const std::vector<std::string>& bags,
                         std::string program)
    : program_(std::move(program)),
      reader_(bags, {config.input.points_topic, config.input.imu_topic}, NeedOf(config)),
      decoder_(config.points),
      pipeline_(config.odometry) {}

OdometryRunSummary OdometryRun::Run(const Sink& sink, const std::string& label) {
  sink_ = sink;
  BagHandlers handlers;
  handlers.points = [this](const BagCloud& cloud) {
    AddCloud(cloud);
    return true;
  };
  handlers.imu = [this](const BagImu& imu) {
    AddImu(imu);
    return true;
  };
  summary_.error = reader_.Read(handlers, label).error;
  Drain(true);
  summary_.counters = pipeline_.counters();
  if (decoder_.time_layout()) summary_.time_layout = decoder_.time_layout()->ToString();
  return summary_;
}

void OdometryRun::AddCloud(const BagCloud& cloud) {
  const auto begin = std::chrono::steady_clock::now();
  DecodedScan decoded = decoder_.Decode(cloud.view);
  const std::chrono::duration<double, std::milli> decode_time =
      std::chrono::steady_clock::now() - begin;
  if (!decoded.error.empty()) {
    ++summary_.clouds_unusable;
    if (decoded.error != last_decode_error_) {
      Warn("cloud at " + ToString(cloud.view.stamp) + ": " + decoded.error);
    }
    last_decode_error_ = decoded.error;
  }
  pipeline_.AddScan(std::move(decoded.scan), decode_time.count());
  Drain(false);
}

void OdometryRun::AddImu(const BagImu& imu) {
  pipeline_.AddImu(imu.sample);
  Drain(false);
  if (clock) clock(imu.sample.stamp);
}

void OdometryRun::Drain(bool flush) {
  while (auto result = flush ? pipeline_.Flush() : pipeline_.ProcessNext()) {
    sink_(std::move(*result));
  }
  for (const std::string& event : pipeline_.TakeEvents()) Warn(event);
}

void OdometryRun::Warn(const std::string& line) const {
  std::fprintf(stderr, "%s: %s\n", program_.c_str(), line.c_str());
}

}  // namespace hv::replay
