#include "hv_sim/faults.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "box_room.h"
#include "hv_core/error.h"

namespace hv::sim {
namespace {

struct Received {
  std::vector<SensorMessage> imu;
  std::vector<SensorMessage> scans;
};

const ImuSample& Imu(const SensorMessage& message) { return std::get<ImuSample>(message.data); }
const Scan& ScanIn(const SensorMessage& message) { return std::get<Scan>(message.data); }

/// Four seconds of a recording, damaged.
Received Receive(const std::vector<std::string>& faults) {
  RecordingConfig config = SmallRecording("hilti", 4.0);
  config.suite.imu.noise = false;
  const Recording recording(BoxRoom(20, 14), config);
  std::vector<Fault> parsed;
  for (const std::string& text : faults) parsed.push_back(ParseFault(text));
  FaultInjector injector(parsed, Time::FromSeconds(config.suite.epoch_s), 1);
  Received received;
  recording.Stream(1, [&](SensorMessage message) {
    if (!injector.Apply(message)) return;
    const bool is_scan = std::holds_alternative<Scan>(message.data);
    (is_scan ? received.scans : received.imu).push_back(std::move(message));
  });
  return received;
}

std::size_t PointCount(const Received& received) {
  std::size_t count = 0;
  for (const SensorMessage& message : received.scans) count += ScanIn(message).points.size();
  return count;
}

class FaultTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { clean_ = new Received(Receive({})); }
  static void TearDownTestSuite() { delete clean_; }
  static Received* clean_;
};

Received* FaultTest::clean_ = nullptr;

TEST_F(FaultTest, WithoutFaultsNothingIsMissing) {
  EXPECT_EQ(clean_->imu.size(), 1601U);
  EXPECT_EQ(clean_->scans.size(), 39U);
  for (std::size_t i = 1; i < clean_->imu.size(); ++i) {
    EXPECT_NEAR(clean_->imu[i].header_stamp - clean_->imu[i - 1].header_stamp, 0.0025, 1e-8);
  }
}

TEST_F(FaultTest, ScanDropout) {
  const Received received = Receive({"scan_dropout:rate=0.5"});
  EXPECT_LT(received.scans.size(), 30U);
  EXPECT_GT(received.scans.size(), 8U);
  EXPECT_EQ(received.imu.size(), clean_->imu.size());
}

TEST_F(FaultTest, PointDropout) {
  const auto kept = static_cast<double>(PointCount(Receive({"point_dropout:rate=0.25"})));
  EXPECT_NEAR(kept / static_cast<double>(PointCount(*clean_)), 0.75, 0.01);
}

TEST_F(FaultTest, Gaps) {
  const Received imu_gap = Receive({"imu_gap:start=1,duration=0.5"});
  EXPECT_EQ(imu_gap.imu.size(), clean_->imu.size() - 200U);
  EXPECT_EQ(imu_gap.scans.size(), clean_->scans.size());
  const Received lidar_gap = Receive({"lidar_gap:start=1,duration=1"});
  EXPECT_EQ(lidar_gap.scans.size(), clean_->scans.size() - 10U);
  EXPECT_EQ(lidar_gap.imu.size(), clean_->imu.size());
}

TEST_F(FaultTest, TimeJitter) {
  const Received received = Receive({"time_jitter:imu_sigma=0.0005,lidar_sigma=0.002"});
  double squares = 0.0;
  for (std::size_t i = 0; i < received.imu.size(); ++i) {
    const double error = received.imu[i].header_stamp - clean_->imu[i].header_stamp;
    EXPECT_EQ(received.imu[i].header_stamp, Imu(received.imu[i]).stamp);
    squares += error * error;
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(received.imu.size())), 0.0005, 5e-5);
  EXPECT_NE(received.scans[5].header_stamp, clean_->scans[5].header_stamp);
  EXPECT_EQ(received.scans[5].arrival, clean_->scans[5].arrival);
}

TEST_F(FaultTest, UnsortedStamps) {
  const Received received = Receive({"unsorted_stamps:rate=0.1"});
  int steps_back = 0;
  for (std::size_t i = 1; i < received.imu.size(); ++i) {
    if (received.imu[i].header_stamp < received.imu[i - 1].header_stamp) ++steps_back;
  }
  EXPECT_GT(steps_back, 80);
  EXPECT_LT(steps_back, 250);
}

TEST_F(FaultTest, ClockJump) {
  const Received received = Receive({"clock_jump:start=2,offset=-3"});
  const auto shift = [&](std::size_t i) {
    return received.imu[i].header_stamp - clean_->imu[i].header_stamp;
  };
  EXPECT_EQ(shift(799), 0.0);
  EXPECT_NEAR(shift(801), -3.0, 1e-9);
  EXPECT_NEAR(ScanIn(received.scans.back()).stamp - ScanIn(clean_->scans.back()).stamp, -3.0, 1e-9);
  EXPECT_EQ(received.imu[801].arrival, clean_->imu[801].arrival);
}

TEST_F(FaultTest, LidarOffset) {
  const Received received = Receive({"lidar_offset:offset=0.05"});
  EXPECT_NEAR(received.scans[3].header_stamp - clean_->scans[3].header_stamp, 0.05, 1e-9);
  EXPECT_EQ(received.imu[3].header_stamp, clean_->imu[3].header_stamp);
}

TEST_F(FaultTest, NanPoints) {
  const Received received = Receive({"nan_points:rate=0.2"});
  std::size_t spoiled = 0;
  for (const SensorMessage& message : received.scans) {
    for (const Point& point : ScanIn(message).points) spoiled += std::isnan(point.x) ? 1U : 0U;
  }
  EXPECT_EQ(PointCount(received), PointCount(*clean_));
  EXPECT_NEAR(static_cast<double>(spoiled) / static_cast<double>(PointCount(received)), 0.2, 0.01);
}

TEST_F(FaultTest, EmptyScans) {
  const Received received = Receive({"empty_scans:rate=0.5"});
  std::size_t empty = 0;
  for (const SensorMessage& message : received.scans) {
    empty += ScanIn(message).points.empty() ? 1U : 0U;
  }
  EXPECT_EQ(received.scans.size(), clean_->scans.size());
  EXPECT_GT(empty, 8U);
  EXPECT_LT(empty, 31U);
}

TEST_F(FaultTest, StampAtEnd) {
  const Received received = Receive({"stamp_at_end"});
  const SensorMessage& message = received.scans[4];
  EXPECT_EQ(message.header_stamp, ScanIn(message).end());
  EXPECT_EQ(ScanIn(message).stamp, ScanIn(clean_->scans[4]).stamp);
}

TEST_F(FaultTest, WrongUnits) {
  const Received received = Receive({"gyro_in_degrees", "accel_in_g"});
  const ImuSample& wrong = Imu(received.imu[1500]);
  const ImuSample& right = Imu(clean_->imu[1500]);
  EXPECT_GT(right.angular_velocity.norm(), 0.0);
  EXPECT_NEAR(wrong.angular_velocity.norm() / right.angular_velocity.norm(), 57.29578, 1e-4);
  EXPECT_NEAR(wrong.acceleration.norm() * 9.80665, right.acceleration.norm(), 1e-9);
}

TEST_F(FaultTest, SameSeedGivesSameDamage) {
  const Received first = Receive({"scan_dropout:rate=0.5", "time_jitter"});
  const Received second = Receive({"scan_dropout:rate=0.5", "time_jitter"});
  ASSERT_EQ(first.scans.size(), second.scans.size());
  for (std::size_t i = 0; i < first.scans.size(); ++i) {
    EXPECT_EQ(first.scans[i].header_stamp, second.scans[i].header_stamp);
  }
}

TEST(KidnapTest, TruthLeavesTheStretchOut) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 100; ++i) {
    Pose pose = Pose::Identity();
    pose.translation().x() = i;
    poses.push_back({Time::FromSeconds(1000.0 + i), pose});
  }
  const Trajectory truth = TruthUnder({ParseFault("kidnap:start=20,by=30")},
                                      Time::FromSeconds(1000.0), Trajectory(poses));
  ASSERT_EQ(truth.size(), 70U);
  EXPECT_EQ(truth.poses()[19].pose.translation().x(), 19.0);
  EXPECT_EQ(truth.poses()[20].stamp, Time::FromSeconds(1020.0));
  EXPECT_EQ(truth.poses()[20].pose.translation().x(), 50.0);
}

TEST_F(FaultTest, KidnapContinuesElsewhereWithoutAGap) {
  const Received received = Receive({"kidnap:start=1,by=2"});
  const std::size_t lost = static_cast<std::size_t>(2.0 * 400.0);
  EXPECT_NEAR(static_cast<double>(clean_->imu.size() - received.imu.size()),
              static_cast<double>(lost), 1.0);
  for (std::size_t i = 1; i < received.imu.size(); ++i) {
    EXPECT_NEAR(Imu(received.imu[i]).stamp - Imu(received.imu[i - 1]).stamp, 0.0025, 0.0011);
  }
  EXPECT_EQ(Imu(received.imu.back()).angular_velocity, Imu(clean_->imu.back()).angular_velocity);
}

std::string ErrorOf(const std::string& text) {
  try {
    ParseFault(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ParseFaultTest, FillsInDefaults) {
  const Fault fault = ParseFault("imu_gap:duration=0.25");
  EXPECT_EQ(fault.name, "imu_gap");
  EXPECT_EQ(fault.parameters.at("duration"), 0.25);
  EXPECT_EQ(fault.parameters.at("start"), 20.0);
  for (const FaultKind& kind : FaultKinds()) {
    EXPECT_EQ(ParseFault(kind.name).parameters, kind.parameters);
  }
}

TEST(ParseFaultTest, NamesWhatIsWrongInOneLine) {
  EXPECT_NE(ErrorOf("imu_gaps").find("'imu_gaps' is unknown"), std::string::npos);
  EXPECT_NE(ErrorOf("imu_gap:begin=3").find("unknown parameter 'begin'"), std::string::npos);
  EXPECT_NE(ErrorOf("imu\ngap").find("'imu?gap' is unknown"), std::string::npos);
  EXPECT_NE(ErrorOf("imu_gap:start=soon").find("'soon' of start"), std::string::npos);
  EXPECT_NE(ErrorOf("imu_gap:start").find("not a number"), std::string::npos);
  EXPECT_NE(ErrorOf("nan_points:rate=nan").find("not a number"), std::string::npos);
  EXPECT_NE(ErrorOf("stamp_at_end:x=1").find("known: none"), std::string::npos);
  for (const char* text : {"imu_gaps", "imu_gap:begin=3", "imu_gap:start=soon"}) {
    EXPECT_EQ(ErrorOf(text).find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace hv::sim
