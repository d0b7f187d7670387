#include "hv_relocalize_ndt/localizer.h"

#include <cmath>
#include <utility>

#include "hv_core/angles.h"
#include "hv_relocalize_ndt/refinement.h"

namespace hv::relocalize {
namespace {

/// The scan in a frame with the axes of the IMU and the origin of the LiDAR, from which surfaces
/// are seen.
std::vector<Eigen::Vector3f> SeenFromLidar(const TrackedScan& scan) {
  const Eigen::Vector3f origin = scan.lidar_in_imu.cast<float>();
  std::vector<Eigen::Vector3f> points;
  points.reserve(scan.points.size());
  for (const Eigen::Vector3f& point : scan.points) points.push_back(point - origin);
  return points;
}

/// Of that frame in the frame of the IMU.
Pose ImuFromLidar(const TrackedScan& scan) {
  return MakePose(Eigen::Matrix3d::Identity(), scan.lidar_in_imu);
}

Pose LidarInOdom(const TrackedScan& scan) { return scan.T_odom_imu * ImuFromLidar(scan); }

}  // namespace

const char* ToString(LocalizerState state) {
  switch (state) {
    case LocalizerState::kLost:
      return "lost";
    case LocalizerState::kDeadReckoning:
      return "dead reckoning";
    case LocalizerState::kTracking:
      return "tracking";
  }
  return "";
}

Localizer::Localizer(const LocalizerConfig& config, const PriorMap& map)
    : config_(config),
      map_(map),
      global_(config.relocalize, map),
      registration_(config.relocalize.ndt),
      filter_(config.tracking),
      recent_(config.submap) {}

LocalizerUpdate Localizer::Add(const TrackedScan& scan) {
  update_ = LocalizerUpdate();
  Follow(scan);
  const TrackingConfig& tracking = config_.tracking;
  const bool lost = state_ == LocalizerState::kLost;
  if (guess_ || (lost && Due(scan.stamp, tracking.search_period_s))) {
    Search(scan);
  } else if (!lost && (contradictions_ > 0 || Due(scan.stamp, tracking.period_s))) {
    Register(scan);
  }
  if (state_ == LocalizerState::kLost) recent_.Add(SeenFromLidar(scan), LidarInOdom(scan));
  return Taken();
}

LocalizerUpdate Localizer::Skip(const TrackedScan& scan) {
  update_ = LocalizerUpdate();
  Follow(scan);
  return Taken();
}

void Localizer::Forget() { Lose("asked to look for the place anew"); }

LocalizerUpdate Localizer::Wait(Time now) {
  update_ = LocalizerUpdate();
  if (state_ != LocalizerState::kLost && last_scan_ &&
      now - *last_scan_ > config_.tracking.silence_s) {
    Lose("no scan");
  }
  return Taken();
}

bool Localizer::Due(Time stamp, double period_s) const {
  constexpr double kJitter_s = 0.02;
  return !last_comparison_ || stamp - *last_comparison_ > period_s - kJitter_s ||
         stamp < *last_comparison_;
}

/// Carries the pose along with odometry, where that is connected.
void Localizer::Follow(const TrackedScan& scan) {
  const double elapsed_s = last_scan_ ? scan.stamp - *last_scan_ : 0.0;
  const bool connected = last_scan_ && scan.segment == segment_;
  const bool silent = elapsed_s > config_.tracking.silence_s || elapsed_s < 0.0;
  if (!connected || silent) {
    recent_.Clear();
    if (state_ != LocalizerState::kLost) {
      Lose(connected ? "no scan for a while" : "odometry started anew");
    }
  } else if (state_ != LocalizerState::kLost) {
    filter_.Predict(scan.T_odom_imu, elapsed_s);
  }
  last_scan_ = scan.stamp;
  segment_ = scan.segment;
}

void Localizer::Lose(std::string reason) {
  state_ = LocalizerState::kLost;
  reason_ = std::move(reason);
  contradictions_ = 0;
  last_comparison_.reset();
  recent_.Clear();
  together_ = false;
}

/// What to look for: the scan near the guess, or anywhere; in turns alone, which is soon done and
/// minds no odometry, and together with what was seen on the way.
LocalizationQuery Localizer::QueryOf(const TrackedScan& scan) {
  LocalizationQuery query;
  query.points = SeenFromLidar(scan);
  query.up = scan.T_odom_imu.linear().row(2);
  if (guess_) {
    query.guess = *guess_;
    query.guess->T_map_scan = guess_->T_map_scan * ImuFromLidar(scan);
    return query;
  }
  const Pose T_odom_lidar = LidarInOdom(scan);
  if (together_ && recent_.Extends(T_odom_lidar)) {
    query.points = recent_.Join(query.points, T_odom_lidar);
  }
  together_ = !together_;
  return query;
}

/// Looks for the place of the scan.
void Localizer::Search(const TrackedScan& scan) {
  const LocalizationResult found = global_.Locate(QueryOf(scan));
  guess_.reset();
  last_comparison_ = scan.stamp;
  update_.registered = update_.searched = true;
  update_.score = found.score;
  update_.found = found.localized;
  update_.refusal = found.reason;
  update_.margin = found.margin;
  update_.lead = found.lead;
  if (!found.localized) {
    if (state_ == LocalizerState::kLost) reason_ = found.reason;
    return;
  }
  const Pose T_imu_scan = ImuFromLidar(scan);
  const Matrix6d transport = se3::Adjoint(T_imu_scan);
  filter_.Start(scan.T_odom_imu, found.T_map_scan * T_imu_scan.inverse(),
                transport * found.covariance * transport.transpose());
  state_ = LocalizerState::kTracking;
  reason_.clear();
  contradictions_ = 0;
}

/// Compares the scan with the map where the robot is believed to be.
void Localizer::Register(const TrackedScan& scan) {
  last_comparison_ = scan.stamp;
  const Pose T_imu_scan = ImuFromLidar(scan);
  const std::vector<Eigen::Vector3f> points = SeenFromLidar(scan);
  const NdtLevel surfaces(map_.surfaces().resolution_m(), points);
  const PlaceJudge judge(config_.relocalize.score, map_.surfaces(), surfaces, points,
                         scan.T_odom_imu.linear().row(2));
  const auto [aligned, score] =
      Refine(map_, registration_, NdtSource(config_.relocalize.ndt, points), judge,
             filter_.T_map_imu() * T_imu_scan);
  update_.registered = true;
  update_.score = score;
  if (update_.score.overlap < config_.tracking.min_overlap) {
    GoOnWithoutMap();
    return;
  }
  const Matrix6d transport = se3::Adjoint(T_imu_scan);
  Weigh(aligned.T_target_source * T_imu_scan.inverse(),
        transport * CovarianceOfComparison(aligned) * transport.transpose());
}

void Localizer::GoOnWithoutMap() {
  state_ = LocalizerState::kDeadReckoning;
  reason_ = "the map does not show this place";
  if (filter_.sigma_m() > config_.tracking.max_sigma_m) Lose("too far without the map");
}

/// Of an alignment, but never better than the best comparison is.
Matrix6d Localizer::CovarianceOfComparison(const NdtResult& aligned) const {
  const TrackingConfig& tracking = config_.tracking;
  const double least_rad = tracking.min_sigma_deg * kRadiansPerDegree;
  Matrix6d covariance = CovarianceOf(aligned, config_.relocalize.covariance_scale);
  covariance.topLeftCorner<3, 3>().diagonal().array() +=
      tracking.min_sigma_m * tracking.min_sigma_m;
  covariance.bottomRightCorner<3, 3>().diagonal().array() += least_rad * least_rad;
  return covariance;
}

/// Takes a measured pose in when it fits and is expected; else counts a contradiction.
void Localizer::Weigh(const Pose& T_map_imu, const Matrix6d& covariance) {
  const TrackingConfig& tracking = config_.tracking;
  update_.innovation = filter_.Distance(T_map_imu, covariance);
  const bool fits = update_.score.agreement() >= tracking.min_agreement &&
                    update_.score.seen_through <= tracking.max_seen_through;
  const bool expected = update_.innovation < tracking.gate_sigmas * tracking.gate_sigmas;
  if (fits && expected) {
    filter_.Correct(T_map_imu, covariance);
    state_ = LocalizerState::kTracking;
    reason_.clear();
    contradictions_ = 0;
    return;
  }
  if (++contradictions_ < tracking.misses) return;
  Lose(fits ? "the map says that the robot is elsewhere" : "what is seen contradicts the map");
}

LocalizerUpdate Localizer::Taken() {
  update_.state = state_;
  update_.reason = reason_;
  update_.T_map_odom = filter_.T_map_odom();
  update_.T_map_imu = filter_.T_map_imu();
  update_.covariance = filter_.covariance();
  return std::move(update_);
}

}  // namespace hv::relocalize
