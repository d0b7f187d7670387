#include "hv_replay/bag_check.h"

#include <algorithm>
#include <set>

#include "bag_findings.h"
#include "rotation_measurement.h"

namespace hv::replay {
namespace {

const char* TypeName(FieldType type) {
  constexpr const char* kNames[] = {"?",     "int8",   "uint8",   "int16",  "uint16",
                                    "int32", "uint32", "float32", "float64"};
  const std::size_t index = static_cast<std::size_t>(type);
  return index < 9 ? kNames[index] : "?";
}

std::string FieldList(const PointCloudView& cloud) {
  std::string text;
  for (const PointFieldView& field : cloud.fields) {
    text += (text.empty() ? "" : " ") + field.name + ":" + TypeName(field.type);
  }
  return text;
}

/// The decoder for the statistics of the clouds.
PointCloudDecoderConfig EveryPoint(PointCloudDecoderConfig config) {
  config.point_stride = 1;
  return config;
}

/// The decoder for the stretch that odometry runs on: fewer points do.
PointCloudDecoderConfig Thinned(PointCloudDecoderConfig config) {
  config.point_stride = std::max(config.point_stride, 4);
  return config;
}

/// Collects everything while the bag is read once.
class Collector {
 public:
  Collector(const lio::SystemConfig& config, const BagCheckOptions& options, Time begin)
      : config_(config),
        options_(options),
        begin_(begin),
        decoder_(EveryPoint(config.points)),
        thin_decoder_(Thinned(config.points)) {}

  bool AddCloud(const BagCloud& cloud) {
    if (stamps_.empty()) {
      figures_.frame_id = cloud.frame_id;
      figures_.fields = FieldList(cloud.view);
    }
    stamps_.push_back(cloud.view.stamp);
    arrivals_.push_back(cloud.arrival);
    DecodedScan decoded = decoder_.Decode(cloud.view);
    if (!decoded.error.empty()) {
      if (figures_.unusable++ == 0) figures_.first_error = decoded.error;
      return true;
    }
    points_in_ += decoded.points_in;
    points_kept_ += decoded.scan.points.size();
    durations_.push_back(decoded.scan.duration);
    for (const Point& point : decoded.scan.points) rings_.insert(point.ring);
    spans_.push_back({decoded.scan.stamp, decoded.scan.end()});
    const double at = cloud.arrival - begin_ - options_.start_s;
    if (at >= 0.0 && at < options_.odometry_s) {
      scans_.push_back(thin_decoder_.Decode(cloud.view).scan);
    }
    return true;
  }

  bool AddImu(const BagImu& imu) {
    imu_stamps_.push_back(imu.sample.stamp);
    imu_arrivals_.push_back(imu.arrival);
    samples_.push_back(imu.sample);
    return true;
  }

  BagCheck Figures() {
    BagCheck check;
    check.points = SummarizeStream(stamps_, arrivals_);
    check.imu = SummarizeStream(imu_stamps_, imu_arrivals_);
    const double scans = static_cast<double>(std::max<std::size_t>(durations_.size(), 1));
    figures_.points_per_scan = static_cast<double>(points_in_) / scans;
    figures_.kept_share = static_cast<double>(points_kept_) /
                          static_cast<double>(std::max<std::size_t>(points_in_, 1));
    figures_.rings = rings_.size();
    figures_.time = decoder_.time_layout();
    if (!durations_.empty()) {
      std::sort(durations_.begin(), durations_.end());
      figures_.sweep_s = durations_[durations_.size() / 2];
    }
    check.cloud = figures_;
    check.readings = SummarizeImu(samples_);
    check.covered_share = CoveredShare();
    std::sort(samples_.begin(), samples_.end(),
              [](const ImuSample& a, const ImuSample& b) { return a.stamp < b.stamp; });
    if (!samples_.empty()) check.rotation = MeasureRotation(scans_, samples_, config_.odometry);
    return check;
  }

 private:
  double CoveredShare() const {
    if (imu_stamps_.empty() || spans_.empty()) return 0.0;
    const auto imu = std::minmax_element(imu_stamps_.begin(), imu_stamps_.end());
    const auto covered = std::count_if(spans_.begin(), spans_.end(), [&](const auto& span) {
      return span.first >= *imu.first && span.second <= *imu.second;
    });
    return static_cast<double>(covered) / static_cast<double>(spans_.size());
  }

  const lio::SystemConfig& config_;
  const BagCheckOptions options_;
  const Time begin_;
  PointCloudDecoder decoder_;
  PointCloudDecoder thin_decoder_;
  std::vector<Scan> scans_;
  CloudFigures figures_;
  std::vector<Time> stamps_, arrivals_, imu_stamps_, imu_arrivals_;
  std::vector<ImuSample> samples_;
  std::vector<double> durations_;
  std::vector<std::pair<Time, Time>> spans_;
  std::set<std::uint16_t> rings_;
  std::size_t points_in_ = 0;
  std::size_t points_kept_ = 0;
};

}  // namespace

bool BagCheck::HasErrors() const {
  return std::any_of(items.begin(), items.end(),
                     [](const CheckItem& item) { return item.level == CheckLevel::kError; });
}

BagCheck CheckBag(BagReader& reader, const lio::SystemConfig& config,
                  const BagCheckOptions& options) {
  Collector collector(config, options, reader.begin());
  BagHandlers handlers;
  handlers.points = [&collector](const BagCloud& cloud) { return collector.AddCloud(cloud); };
  handlers.imu = [&collector](const BagImu& imu) { return collector.AddImu(imu); };
  const BagReadResult read = reader.Read(handlers, "hv_check_bag");
  BagCheck check = collector.Figures();
  if (!read.error.empty()) check.items.push_back({CheckLevel::kError, "bag", read.error});
  if (read.undecodable > 0) {
    check.items.push_back({CheckLevel::kWarning, "bag",
                           std::to_string(read.undecodable) + " messages contradict their type"});
  }
  JudgeBag(config, options, check);
  return check;
}

}  // namespace hv::replay
