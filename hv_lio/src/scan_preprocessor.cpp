#include "hv_lio/scan_preprocessor.h"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace hv::lio {
namespace {

constexpr double kPoseStep = 5e-4;
constexpr std::size_t kPointsPerTask = 4096;
constexpr std::size_t kFirstTableSize = 1U << 16U;

/// Rigid motion as a function of time, linear on one step: p_end = (a + s b) p + (c + s d), s the
/// seconds since the step's start.
struct LinearMotion {
  Eigen::Matrix3f a;
  Eigen::Matrix3f b;
  Eigen::Vector3f c;
  Eigen::Vector3f d;
};

/// Index of the knot whose interval contains `time`, searching on from `from`.
std::size_t AdvanceKnot(const std::vector<MotionKnot>& knots, double time, std::size_t from) {
  while (from + 1 < knots.size() && knots[from + 1].time <= time) ++from;
  return from;
}

std::vector<LinearMotion> LinearizeMotion(const ScanMotion& motion, double duration,
                                          const Pose& T_imu_lidar) {
  const Pose T_end_odom = motion.PoseAt(motion.end_time).inverse();
  const std::size_t steps = static_cast<std::size_t>(std::max(0.0, duration) / kPoseStep) + 1;
  std::vector<LinearMotion> pieces(steps);
  std::size_t knot = 0;
  const auto pose_at = [&](double time) -> Pose {
    knot = AdvanceKnot(motion.knots, time, knot);
    return T_end_odom * motion.knots[knot].PoseAfter(time - motion.knots[knot].time) * T_imu_lidar;
  };
  Pose before = pose_at(0.0);
  for (std::size_t i = 0; i < steps; ++i) {
    const Pose after = pose_at(static_cast<double>(i + 1) * kPoseStep);
    pieces[i].a = before.linear().cast<float>();
    pieces[i].b = ((after.linear() - before.linear()) / kPoseStep).cast<float>();
    pieces[i].c = before.translation().cast<float>();
    pieces[i].d = ((after.translation() - before.translation()) / kPoseStep).cast<float>();
    before = after;
  }
  return pieces;
}

Point MovePoint(const Point& point, const std::vector<LinearMotion>& pieces) {
  const float in_steps = std::max(0.0F, point.time) * static_cast<float>(1.0 / kPoseStep);
  const std::size_t index = std::min(static_cast<std::size_t>(in_steps), pieces.size() - 1);
  const LinearMotion& piece = pieces[index];
  const float s = point.time - static_cast<float>(index) * static_cast<float>(kPoseStep);
  const Eigen::Vector3f p(point.x, point.y, point.z);
  const Eigen::Vector3f moved = piece.a * p + piece.c + s * (piece.b * p + piece.d);
  Point result = point;
  result.x = moved.x();
  result.y = moved.y();
  result.z = moved.z();
  return result;
}

/// 21 bits an axis; the offset keeps the packed parts positive within +-2^20 cells.
std::uint64_t PackKey(float x, float y, float z, float inverse_size) {
  constexpr std::int64_t kOffset = 1 << 20;
  const auto part = [inverse_size](float value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value * inverse_size)) +
                                      kOffset) &
           0x1FFFFFU;
  };
  return (part(x) << 42U) | (part(y) << 21U) | part(z);
}

std::uint64_t Mix(std::uint64_t key) {
  key ^= key >> 31U;
  key *= 0x9E3779B97F4A7C15ULL;
  return key ^ (key >> 29U);
}

}  // namespace

void PreprocessConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("cell_size_m", cell_size_m, "edge of the cells a scan is grouped into [m]");
  visitor.Field("range_sigma_m", range_sigma_m, "standard deviation of a range [m]");
  visitor.Field("bearing_sigma_rad", bearing_sigma_rad,
                "standard deviation of a beam's direction [rad]");
  visitor.Field("max_cells", max_cells, "cells used of one scan, spread evenly");
}

void PreprocessConfig::Validate(ConfigProblems& problems) const {
  problems.Require(cell_size_m >= 0.02, "preprocess.cell_size_m", "must be at least 0.02");
  problems.Require(range_sigma_m > 0.0, "preprocess.range_sigma_m", "must be positive");
  problems.Require(bearing_sigma_rad > 0.0, "preprocess.bearing_sigma_rad", "must be positive");
  problems.Require(max_cells >= 100, "preprocess.max_cells", "must be at least 100");
}

Pose ScanMotion::PoseAt(double time) const {
  const MotionKnot& knot = knots[AdvanceKnot(knots, time, 0)];
  return knot.PoseAfter(time - knot.time);
}

std::vector<Point> Deskew(const Scan& scan, const ScanMotion& motion, const Pose& T_imu_lidar) {
  const std::vector<LinearMotion> pieces = LinearizeMotion(motion, scan.duration, T_imu_lidar);
  std::vector<Point> moved(scan.points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, moved.size(), kPointsPerTask),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        moved[i] = MovePoint(scan.points[i], pieces);
                      }
                    });
  return moved;
}

CellGrid::CellGrid(const PreprocessConfig& config) : config_(config), table_(kFirstTableSize) {
  sums_.reserve(kFirstTableSize / 2);
}

void CellGrid::Grow() {
  std::vector<Slot> old(table_.size() * 2);
  old.swap(table_);
  for (const Slot& slot : old) {
    if (slot.generation != generation_) continue;
    std::size_t at = Mix(slot.key) & (table_.size() - 1);
    while (table_[at].generation == generation_) at = (at + 1) & (table_.size() - 1);
    table_[at] = slot;
  }
}

std::uint32_t CellGrid::FindOrAdd(std::uint64_t key, const Point& point) {
  if (2 * sums_.size() >= table_.size()) Grow();
  std::size_t at = Mix(key) & (table_.size() - 1);
  while (table_[at].generation == generation_) {
    if (table_[at].key == key) return table_[at].index;
    at = (at + 1) & (table_.size() - 1);
  }
  const auto index = static_cast<std::uint32_t>(sums_.size());
  table_[at] = {key, index, generation_};
  sums_.push_back({{point.x, point.y, point.z}, 0.0F, {0, 0, 0}, {0, 0, 0, 0, 0, 0}});
  return index;
}

std::vector<SurfaceCell> CellGrid::Group(const std::vector<Point>& points,
                                         const Eigen::Vector3d& sensor_origin) {
  ++generation_;
  sums_.clear();
  const float inverse_size = static_cast<float>(1.0 / config_.cell_size_m);
  const float reach = static_cast<float>(config_.cell_size_m) * 1e6F;
  for (const Point& point : points) {
    const float largest = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
    if (!(largest < reach)) continue;
    Sums& sums = sums_[FindOrAdd(PackKey(point.x, point.y, point.z, inverse_size), point)];
    const float x = point.x - sums.origin[0];
    const float y = point.y - sums.origin[1];
    const float z = point.z - sums.origin[2];
    sums.count += 1.0F;
    sums.sum[0] += x;
    sums.sum[1] += y;
    sums.sum[2] += z;
    sums.outer[0] += x * x;
    sums.outer[1] += x * y;
    sums.outer[2] += x * z;
    sums.outer[3] += y * y;
    sums.outer[4] += y * z;
    sums.outer[5] += z * z;
  }
  const std::size_t limit = static_cast<std::size_t>(config_.max_cells);
  const std::size_t kept = std::min(sums_.size(), limit);
  std::vector<SurfaceCell> cells(kept);
  for (std::size_t i = 0; i < kept; ++i) {
    cells[i] = Finish(sums_[i * sums_.size() / kept], sensor_origin);
  }
  return cells;
}

SurfaceCell CellGrid::Finish(const Sums& sums, const Eigen::Vector3d& sensor_origin) const {
  SurfaceCell cell;
  cell.count = static_cast<double>(sums.count);
  const Eigen::Vector3d origin(sums.origin[0], sums.origin[1], sums.origin[2]);
  const Eigen::Vector3d offset =
      Eigen::Vector3d(sums.sum[0], sums.sum[1], sums.sum[2]) / cell.count;
  cell.mean = origin + offset;
  Eigen::Matrix3d outer;
  outer << sums.outer[0], sums.outer[1], sums.outer[2],  //
      sums.outer[1], sums.outer[3], sums.outer[4],       //
      sums.outer[2], sums.outer[4], sums.outer[5];
  cell.scatter = outer / cell.count - offset * offset.transpose();

  const Eigen::Vector3d beam = cell.mean - sensor_origin;
  const double range_squared = std::max(1e-6, beam.squaredNorm());
  const Eigen::Matrix3d along = beam * beam.transpose() / range_squared;
  const double across = range_squared * config_.bearing_sigma_rad * config_.bearing_sigma_rad;
  cell.noise = config_.range_sigma_m * config_.range_sigma_m * along +
               across * (Eigen::Matrix3d::Identity() - along);
  return cell;
}

}  // namespace hv::lio
