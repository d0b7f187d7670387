#include "hv_sim/faults.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <random>
#include <sstream>
#include <utility>

#include "hv_core/error.h"
#include "hv_core/one_line.h"

namespace hv::sim {
namespace {

using Parameters = std::map<std::string, double>;

/// What the effect of a fault may look at: its parameters, seconds since the start, random numbers.
struct Context {
  const Parameters& parameters;
  double time_s;
  std::mt19937_64& random;

  double operator[](const char* key) const { return parameters.at(key); }
  bool Chance(double probability) const {
    return std::uniform_real_distribution<double>(0.0, 1.0)(random) < probability;
  }
  bool InWindow() const {
    const double since = time_s - (*this)["start"];
    return since >= 0.0 && since < (*this)["duration"];
  }
};

/// False when the message is lost.
using Effect = bool (*)(SensorMessage&, const Context&);

Scan* ScanOf(SensorMessage& message) { return std::get_if<Scan>(&message.data); }
ImuSample* ImuOf(SensorMessage& message) { return std::get_if<ImuSample>(&message.data); }

void ShiftStamps(SensorMessage& message, double seconds) {
  message.header_stamp = message.header_stamp + seconds;
  if (Scan* scan = ScanOf(message)) scan->stamp = scan->stamp + seconds;
  if (ImuSample* imu = ImuOf(message)) imu->stamp = imu->stamp + seconds;
}

void ClearScan(Scan& scan) {
  scan.points.clear();
  scan.duration = 0.0;
}

bool LoseScans(SensorMessage& message, const Context& context) {
  return ScanOf(message) == nullptr || !context.Chance(context["rate"]);
}

bool LosePoints(SensorMessage& message, const Context& context) {
  Scan* scan = ScanOf(message);
  if (scan == nullptr) return true;
  std::vector<Point> kept;
  for (const Point& point : scan->points) {
    if (!context.Chance(context["rate"])) kept.push_back(point);
  }
  scan->points = std::move(kept);
  return true;
}

bool LoseImu(SensorMessage& message, const Context& context) {
  return ImuOf(message) == nullptr || !context.InWindow();
}

bool LoseLidar(SensorMessage& message, const Context& context) {
  return ScanOf(message) == nullptr || !context.InWindow();
}

bool Jitter(SensorMessage& message, const Context& context) {
  const double sigma =
      ScanOf(message) != nullptr ? context["lidar_sigma"] : context["imu_sigma"];
  if (sigma > 0.0) {
    ShiftStamps(message, std::normal_distribution<double>(0.0, sigma)(context.random));
  }
  return true;
}

bool Unsort(SensorMessage& message, const Context& context) {
  if (ImuOf(message) != nullptr && context.Chance(context["rate"])) {
    ShiftStamps(message, -context["by"]);
  }
  return true;
}

bool JumpClock(SensorMessage& message, const Context& context) {
  if (context.time_s >= context["start"]) ShiftStamps(message, context["offset"]);
  return true;
}

/// What happens in the time that is left out is never seen: the carrier is suddenly elsewhere.
bool Kidnap(SensorMessage& message, const Context& context) {
  if (context.time_s < context["start"]) return true;
  if (context.time_s < context["start"] + context["by"]) return false;
  ShiftStamps(message, -context["by"]);
  message.arrival = message.arrival - context["by"];
  return true;
}

bool OffsetLidar(SensorMessage& message, const Context& context) {
  if (ScanOf(message) != nullptr) ShiftStamps(message, context["offset"]);
  return true;
}

bool SpoilPoints(SensorMessage& message, const Context& context) {
  Scan* scan = ScanOf(message);
  if (scan == nullptr) return true;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (Point& point : scan->points) {
    if (context.Chance(context["rate"])) point.x = point.y = point.z = kNan;
  }
  return true;
}

bool EmptyScans(SensorMessage& message, const Context& context) {
  Scan* scan = ScanOf(message);
  if (scan != nullptr && context.Chance(context["rate"])) ClearScan(*scan);
  return true;
}

bool StampAtEnd(SensorMessage& message, const Context&) {
  if (const Scan* scan = ScanOf(message)) message.header_stamp = scan->end();
  return true;
}

bool GyroInDegrees(SensorMessage& message, const Context&) {
  if (ImuSample* imu = ImuOf(message)) imu->angular_velocity *= 180.0 / M_PI;
  return true;
}

bool AccelInG(SensorMessage& message, const Context&) {
  if (ImuSample* imu = ImuOf(message)) imu->acceleration /= kGravity;
  return true;
}

bool LeaveStream(SensorMessage&, const Context&) { return true; }

struct KnownFault {
  FaultKind kind;
  Effect effect;
};

const std::vector<KnownFault>& KnownFaults() {
  static const std::vector<KnownFault> kKnown = {
      {{"scan_dropout", "loses scans with probability rate", {{"rate", 0.05}}}, LoseScans},
      {{"point_dropout", "loses points with probability rate", {{"rate", 0.3}}}, LosePoints},
      {{"imu_gap", "no IMU for a while", {{"start", 20.0}, {"duration", 0.5}}}, LoseImu},
      {{"lidar_gap", "no scans for a while", {{"start", 20.0}, {"duration", 1.0}}}, LoseLidar},
      {{"time_jitter", "Gaussian error of the stamps [s]",
        {{"imu_sigma", 0.0005}, {"lidar_sigma", 0.001}}}, Jitter},
      {{"unsorted_stamps", "IMU stamps step back by [s] with probability rate",
        {{"rate", 0.01}, {"by", 0.012}}}, Unsort},
      {{"clock_jump", "all stamps shift by offset [s] from start on",
        {{"start", 20.0}, {"offset", 5.0}}}, JumpClock},
      {{"kidnap", "from start on, the sensors are where they would be by [s] later",
        {{"start", 20.0}, {"by", 30.0}}}, Kidnap},
      {{"lidar_offset", "LiDAR stamps are off by [s]", {{"offset", 0.02}}}, OffsetLidar},
      {{"nan_points", "points become NaN with probability rate", {{"rate", 0.05}}}, SpoilPoints},
      {{"empty_scans", "scans lose all points with probability rate", {{"rate", 0.05}}},
       EmptyScans},
      {{"stamp_at_end", "headers carry the time of the last point", {}}, StampAtEnd},
      {{"gyro_in_degrees", "angular velocity in deg/s", {}}, GyroInDegrees},
      {{"accel_in_g", "acceleration in multiples of gravity", {}}, AccelInG},
      {{"truncated_bag", "the bag ends after a share of its bytes", {{"keep", 0.7}}},
       LeaveStream}};
  return kKnown;
}

const KnownFault& FindFault(const std::string& name) {
  std::string names;
  for (const KnownFault& known : KnownFaults()) {
    if (known.kind.name == name) return known;
    names += (names.empty() ? "" : ", ") + known.kind.name;
  }
  throw InputError("fault '" + name + "' is unknown; known are " + names);
}

void ParseParameter(const std::string& item, const std::string& text, Parameters& parameters) {
  const std::size_t equals = item.find('=');
  const std::string key = item.substr(0, equals);
  if (parameters.count(key) == 0) {
    std::string known;
    for (const auto& [name, value] : parameters) known += " " + name;
    throw InputError("fault '" + text + "': unknown parameter '" + key + "'; known:" +
                     (known.empty() ? " none" : known));
  }
  const std::string value = equals == std::string::npos ? "" : item.substr(equals + 1);
  std::istringstream stream(value);
  if (!(stream >> parameters[key]) || !stream.eof()) {
    throw InputError("fault '" + text + "': '" + value + "' of " + key + " is not a number");
  }
}

}  // namespace

const std::vector<FaultKind>& FaultKinds() {
  static const std::vector<FaultKind> kKinds = [] {
    std::vector<FaultKind> kinds;
    for (const KnownFault& known : KnownFaults()) kinds.push_back(known.kind);
    return kinds;
  }();
  return kKinds;
}

Fault ParseFault(const std::string& given) {
  const std::string text = OneLine(given);  // errors quote it
  const std::size_t colon = text.find(':');
  Fault fault;
  fault.name = text.substr(0, colon);
  fault.parameters = FindFault(fault.name).kind.parameters;
  if (colon == std::string::npos) return fault;
  std::istringstream items(text.substr(colon + 1));
  for (std::string item; std::getline(items, item, ',');) {
    ParseParameter(item, text, fault.parameters);
  }
  return fault;
}

struct FaultInjector::Active {
  Effect effect;
  Parameters parameters;
  Time start;
  std::mt19937_64 random;
};

FaultInjector::FaultInjector(const std::vector<Fault>& faults, Time start, std::uint32_t seed) {
  for (const Fault& fault : faults) {
    const std::uint64_t own_seed = (std::uint64_t{seed} << 32U) + active_.size();
    active_.push_back(std::make_unique<Active>(Active{
        FindFault(fault.name).effect, fault.parameters, start, std::mt19937_64(own_seed)}));
  }
}

FaultInjector::~FaultInjector() = default;

bool FaultInjector::Apply(SensorMessage& message) {
  for (const std::unique_ptr<Active>& fault : active_) {
    const double time_s = message.arrival - fault->start;
    if (!fault->effect(message, {fault->parameters, time_s, fault->random})) return false;
  }
  return true;
}

Trajectory TruthUnder(const std::vector<Fault>& faults, Time start, const Trajectory& truth) {
  std::vector<StampedPose> poses = truth.poses();
  for (const Fault& fault : faults) {
    if (fault.name != "kidnap") continue;
    const Time from = start + fault.parameters.at("start");
    const double by = fault.parameters.at("by");
    std::vector<StampedPose> kept;
    for (StampedPose pose : poses) {
      if (!(pose.stamp < from) && pose.stamp < from + by) continue;
      if (!(pose.stamp < from)) pose.stamp = pose.stamp - by;
      kept.push_back(pose);
    }
    poses = std::move(kept);
  }
  return Trajectory(std::move(poses));
}

void TruncateIfAsked(const std::vector<Fault>& faults, const std::string& path) {
  for (const Fault& fault : faults) {
    if (fault.name != "truncated_bag") continue;
    std::error_code error;
    const auto size = static_cast<double>(std::filesystem::file_size(path, error));
    if (!error) {
      const auto kept = static_cast<std::uintmax_t>(size * fault.parameters.at("keep"));
      std::filesystem::resize_file(path, kept, error);
    }
    if (error) throw InputError(path + ": cannot be truncated: " + error.message());
  }
}

}  // namespace hv::sim
