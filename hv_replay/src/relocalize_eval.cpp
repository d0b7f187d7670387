#include "hv_replay/relocalize_eval.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "hv_core/angles.h"
#include "hv_core/elapsed.h"
#include "hv_core/error.h"
#include "hv_core/map_folder.h"
#include "hv_core/point_cloud_file.h"
#include "hv_core/trajectory.h"
#include "hv_relocalize_ndt/global_localizer.h"
#include "hv_replay/cloud_folder.h"
#include "hv_replay/console.h"
#include "hv_replay/csv_log.h"
#include "hv_replay/trajectory_error.h"

namespace hv::replay {
namespace {

constexpr double kSuccess_m = 0.10;
constexpr double kSuccess_deg = 3.0;

using Clock = std::chrono::steady_clock;

std::vector<Eigen::Vector3f> ReadPositions(const std::string& path) {
  std::vector<Eigen::Vector3f> points;
  for (const Point& point : ReadPointCloud(path).points) {
    points.emplace_back(point.x, point.y, point.z);
  }
  return points;
}

Eigen::Vector3d RandomDirection(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random);
  const double y = normal(random);
  const double z = normal(random);
  return Eigen::Vector3d(x, y, z).normalized();
}

/// The pose, moved and turned about itself by given amounts in random directions.
Pose Perturbed(const Pose& pose, const RelocalizeTrials::Perturbation& by, std::mt19937& random) {
  const Eigen::Vector3d step = by.translation_m * RandomDirection(random);
  const Eigen::AngleAxisd turn(by.rotation_deg * kRadiansPerDegree, RandomDirection(random));
  Pose moved = pose;
  moved.translation() += step;
  moved.linear() = pose.linear() * turn.toRotationMatrix();
  return moved;
}

std::string Columns(const char* name) {
  std::string columns;
  for (const char* part : {"x", "y", "z", "qx", "qy", "qz", "qw"}) {
    columns += std::string(",") + name + "_" + part;
  }
  return columns;
}

std::string Row(const std::optional<Pose>& pose) {
  if (!pose) return ",,,,,,,";
  const Eigen::Vector3d& t = pose->translation();
  const Eigen::Quaterniond q(pose->linear());
  char text[256];
  std::snprintf(text, sizeof(text), ",%.6f,%.6f,%.6f,%.9f,%.9f,%.9f,%.9f", t.x(), t.y(), t.z(),
                q.x(), q.y(), q.z(), q.w());
  return text;
}

/// Truth in the frame of the map, one pose a cloud; empty when there is none.
std::vector<Pose> TruthInMap(const RelocalizeTrials& trials, std::size_t clouds) {
  std::vector<Pose> truth;
  if (trials.poses.empty()) return truth;
  Pose T_map_world = Pose::Identity();
  if (!trials.map_truth.empty()) {
    T_map_world =
        CompareTrajectories(MapFolder::Open(trials.map).ReadPoses(), ReadTum(trials.map_truth), {})
            .T_reference_estimate;
  }
  const Trajectory poses = ReadTum(trials.poses);
  for (const StampedPose& pose : poses.poses()) {
    truth.push_back(T_map_world * pose.pose);
  }
  if (truth.size() != clouds) {
    throw InputError(trials.poses + ": " + std::to_string(truth.size()) + " poses for " +
                     std::to_string(clouds) + " clouds");
  }
  return truth;
}

/// The points with a share of the columns of the map exchanged among each other.
std::vector<Eigen::Vector3f> Changed(std::vector<Eigen::Vector3f> points, double share,
                                     std::uint32_t seed) {
  constexpr float kColumn_m = 1.5F;
  using Column = std::pair<int, int>;
  const auto column_of = [](const Eigen::Vector3f& point) {
    return Column(static_cast<int>(std::floor(point.x() / kColumn_m)),
                  static_cast<int>(std::floor(point.y() / kColumn_m)));
  };
  std::set<Column> occupied;
  for (const Eigen::Vector3f& point : points) occupied.insert(column_of(point));
  std::vector<Column> from(occupied.begin(), occupied.end());
  std::mt19937 random(seed);
  std::shuffle(from.begin(), from.end(), random);
  from.resize(static_cast<std::size_t>(share * static_cast<double>(from.size())));
  std::map<Column, Column> target;
  for (std::size_t i = 0; i < from.size(); ++i) target[from[i]] = from[(i + 1) % from.size()];
  for (Eigen::Vector3f& point : points) {
    const auto moved = target.find(column_of(point));
    if (moved == target.end()) continue;
    point.x() += kColumn_m * static_cast<float>(moved->second.first - moved->first.first);
    point.y() += kColumn_m * static_cast<float>(moved->second.second - moved->first.second);
  }
  return points;
}

relocalize::PriorMap LoadMap(const RelocalizeTrials& trials,
                             const relocalize::RelocalizeConfig& config) {
  relocalize::PriorMap map = relocalize::PriorMap::Load(trials.map, config);
  if (trials.changed_share <= 0.0) return map;
  return {trials.map, Changed(map.points(), trials.changed_share, trials.seed), config};
}

struct Answer {
  bool localized = true;
  std::string reason;
  Pose pose = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();
  relocalize::PlaceScore score;
  double margin = 0.0;
  double lead = 0.0;
  std::string origin;
};

/// The error over what the covariance lets expect; 0 without a covariance.
double ErrorInSigmas(const Answer& answer, const Pose& truth) {
  if (answer.covariance.isZero()) return 0.0;
  const Vector6d error = se3::Log(answer.pose.inverse() * truth);
  return std::sqrt(error.dot(answer.covariance.ldlt().solve(error)) / 6.0);
}

class Trials {
 public:
  Trials(const RelocalizeTrials& trials, const relocalize::RelocalizeConfig& config)
      : trials_(trials),
        files_(CloudFiles(trials.clouds)),
        truth_(TruthInMap(trials, files_.size())),
        config_(config),
        started_(Clock::now()),
        map_(LoadMap(trials, config)),
        load_ms_(MillisecondsSince(started_)),
        localizer_(config, map_),
        random_(trials.seed) {
    if (files_.empty()) throw InputError(trials.clouds + ": holds no PCD or PLY file");
    if (trials.perturbation && truth_.empty()) {
      throw InputError("guesses near the truth need true poses");
    }
  }

  RelocalizeSummary Run(const std::string& csv) {
    CsvLog log(csv,
               "trial,cloud" + Columns("truth") + Columns("guess") + Columns("result") +
                   ",localized,error_m,error_deg,sigma_m,sigma_deg,ms,fit,overlap,seen_through,"
                   "margin,lead,origin,reason");
    const std::size_t count =
        trials_.count > 0 ? static_cast<std::size_t>(trials_.count) : files_.size();
    ProgressLine progress("trials");
    for (std::size_t trial = 0; trial < count; ++trial) {
      log.Append(std::to_string(trial) + "," + Try(trial % files_.size()));
      progress.Update(static_cast<double>(trial + 1) / static_cast<double>(count), "");
    }
    return Summarized(count);
  }

 private:
  Answer Ask(const std::vector<Eigen::Vector3f>& points, const std::optional<Pose>& guess) const {
    Answer answer;
    if (trials_.ndt_alone && guess) {
      answer.pose = relocalize::NdtRegistration(config_.ndt)
                        .Align(map_.Levels(), relocalize::NdtSource(config_.ndt, points), *guess)
                        .T_target_source;
      answer.origin = "guess";
      return answer;
    }
    relocalize::LocalizationQuery query;
    query.points = points;
    if (guess) {
      query.guess = relocalize::PoseGuess{*guess, trials_.guess_radius_m,
                                          trials_.guess_heading_deg * kRadiansPerDegree};
    }
    const relocalize::LocalizationResult result = localizer_.Locate(query);
    answer = {result.localized, result.reason, result.T_map_scan, result.covariance,
              result.score,     result.margin, result.lead,       ""};
    if (!result.candidates.empty()) answer.origin = result.candidates.front().origin;
    return answer;
  }

  std::string Try(std::size_t number) {
    const std::vector<Eigen::Vector3f> points = ReadPositions(files_[number]);
    std::optional<Pose> truth;
    std::optional<Pose> guess;
    if (!truth_.empty()) truth = truth_[number];
    if (trials_.perturbation) guess = Perturbed(*truth, *trials_.perturbation, random_);
    const Clock::time_point start = Clock::now();
    const Answer answer = Ask(points, guess);
    const double ms = MillisecondsSince(start);
    durations_.push_back(ms);
    double error_m = -1.0;
    double error_deg = -1.0;
    if (truth) {
      error_m = (answer.pose.translation() - truth->translation()).norm();
      error_deg = RotationDistance(answer.pose, *truth) / kRadiansPerDegree;
    }
    answered_ += answer.localized ? 1 : 0;
    if (answer.localized && truth && error_m < kSuccess_m && error_deg < kSuccess_deg) {
      errors_.push_back(error_m);
      in_sigmas_.push_back(ErrorInSigmas(answer, *truth));
    }
    char text[300];
    std::snprintf(
        text, sizeof(text), ",%d,%.5f,%.5f,%.5f,%.5f,%.2f,%.4f,%.4f,%.4f,%.4f,%.2f,%s,",
        answer.localized ? 1 : 0, error_m, error_deg,
        std::sqrt(answer.covariance.topLeftCorner<3, 3>().trace()),
        std::sqrt(answer.covariance.bottomRightCorner<3, 3>().trace()) / kRadiansPerDegree, ms,
        answer.score.fit, answer.score.overlap, answer.score.seen_through, answer.margin,
        answer.lead, answer.origin.c_str());
    return std::filesystem::path(files_[number]).filename().string() + Row(truth) + Row(guess) +
           Row(answer.pose) + text + answer.reason;
  }

  RelocalizeSummary Summarized(std::size_t count) const {
    RelocalizeSummary summary;
    summary.trials = count;
    summary.answered = answered_;
    summary.successes = errors_.size();
    const Statistics errors = Summarize(errors_);
    summary.rmse_m = errors.rmse;
    summary.mean_m = errors.mean;
    summary.error_in_sigmas = Summarize(in_sigmas_).rmse;
    const Statistics durations = Summarize(durations_);
    summary.median_ms = durations.median;
    summary.max_ms = durations.max;
    summary.load_ms = load_ms_;
    return summary;
  }

  const RelocalizeTrials& trials_;
  std::vector<std::string> files_;
  std::vector<Pose> truth_;  ///< in the map, one a cloud
  relocalize::RelocalizeConfig config_;
  Clock::time_point started_;
  relocalize::PriorMap map_;
  double load_ms_;
  relocalize::GlobalLocalizer localizer_;
  std::mt19937 random_;
  std::size_t answered_ = 0;
  std::vector<double> errors_;     ///< of the successes [m]
  std::vector<double> in_sigmas_;  ///< of the successes
  std::vector<double> durations_;
};

}  // namespace

RelocalizeSummary TryRelocalization(const RelocalizeTrials& trials,
                                    const relocalize::RelocalizeConfig& config,
                                    const std::string& csv) {
  return Trials(trials, config).Run(csv);
}

}  // namespace hv::replay
