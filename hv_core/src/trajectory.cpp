#include "hv_core/trajectory.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "hv_core/error.h"

namespace hv {
namespace {

bool Earlier(const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; }

/// Parses one line of a TUM file; nullopt when it is malformed.
std::optional<StampedPose> ParseTumLine(std::string line) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream stream(line);
  std::string stamp_text;
  Eigen::Vector3d position;
  Eigen::Quaterniond rotation;
  std::string excess;
  stream >> stamp_text >> position.x() >> position.y() >> position.z();
  stream >> rotation.x() >> rotation.y() >> rotation.z() >> rotation.w();
  if (!stream || (stream >> excess)) return std::nullopt;
  const std::optional<Time> stamp = ParseTime(stamp_text);
  const double norm = rotation.norm();
  if (!stamp || !position.allFinite() || !(norm > 0.5 && norm < 2.0)) return std::nullopt;
  return StampedPose{*stamp, MakePose(rotation, position)};
}

Trajectory ReadTumLines(std::istream& file, const std::string& path) {
  std::vector<StampedPose> poses;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    const std::optional<StampedPose> pose = ParseTumLine(line);
    if (!pose) {
      throw InputError(path + ":" + std::to_string(number) +
                       ": expected 'stamp x y z qx qy qz qw' with a unit quaternion");
    }
    poses.push_back(*pose);
  }
  if (file.bad()) throw InputError(path + ": cannot be read");
  return Trajectory(std::move(poses));
}

}  // namespace

Trajectory::Trajectory(std::vector<StampedPose> poses) : poses_(std::move(poses)) {
  std::stable_sort(poses_.begin(), poses_.end(), Earlier);
  std::vector<StampedPose> unique;
  unique.reserve(poses_.size());
  for (const StampedPose& pose : poses_) {
    if (!unique.empty() && unique.back().stamp == pose.stamp) unique.pop_back();
    unique.push_back(pose);
  }
  poses_ = std::move(unique);
}

bool Trajectory::Append(Time stamp, const Pose& pose) {
  if (!poses_.empty() && stamp <= poses_.back().stamp) return false;
  poses_.push_back({stamp, pose});
  return true;
}

std::optional<Pose> Trajectory::Interpolate(Time stamp, double max_gap) const {
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), StampedPose{stamp, Pose::Identity()}, Earlier);
  if (after == poses_.end()) return std::nullopt;
  if (after->stamp == stamp) return after->pose;
  if (after == poses_.begin()) return std::nullopt;
  const auto before = after - 1;
  const double gap = after->stamp - before->stamp;
  if (gap > max_gap) return std::nullopt;
  const double ratio = (stamp - before->stamp) / gap;
  const Eigen::Vector3d position =
      (1.0 - ratio) * before->pose.translation() + ratio * after->pose.translation();
  const Eigen::Quaterniond start(before->pose.linear());
  const Eigen::Quaterniond finish(after->pose.linear());
  return MakePose(start.slerp(ratio, finish), position);
}

double Trajectory::PathLength() const {
  double length = 0.0;
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    length += (poses_[i].pose.translation() - poses_[i - 1].pose.translation()).norm();
  }
  return length;
}

Trajectory ReadTum(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be opened");
  return ReadTumLines(file, path);
}

Trajectory ParseTum(const std::string& text, const std::string& source) {
  std::istringstream stream(text);
  return ReadTumLines(stream, source);
}

void WriteTum(const std::string& path, const Trajectory& trajectory) {
  const std::string temporary = path + ".part";
  std::FILE* file = std::fopen(temporary.c_str(), "w");
  if (file == nullptr) throw InputError(path + ": cannot be written");
  std::fputs("# stamp[s] x[m] y[m] z[m] qx qy qz qw\n", file);
  for (const StampedPose& stamped : trajectory.poses()) {
    const Eigen::Vector3d position = stamped.pose.translation();
    const Eigen::Quaterniond rotation(stamped.pose.linear());
    std::fprintf(file, "%s %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n",
                 ToString(stamped.stamp).c_str(), position.x(), position.y(), position.z(),
                 rotation.x(), rotation.y(), rotation.z(), rotation.w());
  }
  const bool written = std::ferror(file) == 0;
  const bool closed = std::fclose(file) == 0;
  if (!written || !closed || std::rename(temporary.c_str(), path.c_str()) != 0) {
    std::remove(temporary.c_str());
    throw InputError(path + ": cannot be written (disk full or not permitted)");
  }
}

}  // namespace hv
