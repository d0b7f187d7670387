#include "hv_navigation/obstacle_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "height_octree.h"
#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "scan_marks.h"

namespace hv::navigation {
namespace {

constexpr int kBlock = ScanMarks::kBlockSide;

MarkModel ModelOf(const SensorModelConfig& config, Sensor sensor) {
  return {octomap::logodds(config.hit), octomap::logodds(config.miss), sensor == Sensor::kLidar};
}

/// How far the rays of a scan clear, one after the other: not all of them far, since what is there
/// changes little from scan to scan, and is most of the work.
class RayReach {
 public:
  RayReach(const SensorModelConfig& model, std::size_t scan) : model_(model), turn_(scan) {}

  double Next() {
    const bool far = turn_++ % static_cast<std::size_t>(model_.far_every) == 0;
    return far ? model_.clear_range_m : std::min(model_.clear_range_m, model_.far_m);
  }

 private:
  const SensorModelConfig& model_;
  std::size_t turn_;
};

Eigen::Vector3d InSensor(const Point& point) {
  return Eigen::Vector3f(point.x, point.y, point.z).cast<double>();
}

}  // namespace

struct ObstacleMap::Impl {
  explicit Impl(const ObstacleMapConfig& config) : tree(config.voxel_m) {
    tree.setClampingThresMin(config.least);
    tree.setClampingThresMax(config.most);
    MoveTo(Eigen::Vector3d::Zero(), config);
  }

  void MoveTo(const Eigen::Vector3d& robot, const ObstacleMapConfig& config) {
    const double block_m = kBlock * config.voxel_m;
    const Eigen::Vector3d half_m(config.region_m, config.region_m, config.region_height_m);
    const Eigen::Vector3i half = (half_m / block_m).array().ceil().cast<int>();
    const Eigen::Vector3i middle = (robot / block_m).array().floor().cast<int>();
    const Eigen::Vector3i low = middle - half;
    const Eigen::Vector3i size = 2 * half + Eigen::Vector3i::Ones();
    if (low == marks.low_block() && size == marks.blocks()) return;
    marks.SetBox(low, size);
    tree.KeepBox(low * kBlock, (low + size) * kBlock);
  }

  HeightOcTree tree;
  ScanMarks marks;
  std::array<std::size_t, 2> scans{};  ///< taken of each sensor
};

ObstacleMap::ObstacleMap(const ObstacleMapConfig& config)
    : config_(config), impl_(std::make_unique<Impl>(config)) {}
ObstacleMap::~ObstacleMap() = default;
ObstacleMap::ObstacleMap(ObstacleMap&&) noexcept = default;
ObstacleMap& ObstacleMap::operator=(ObstacleMap&&) noexcept = default;

void ObstacleMap::MoveTo(const Eigen::Vector3d& robot) {
  const double half_m = std::max(config_.region_m, config_.region_height_m);
  const Eigen::Vector3d corner = (robot.array().abs() + half_m) / config_.voxel_m + 2.0 * kBlock;
  if (!robot.allFinite() || !impl_->tree.InReach(corner)) return;
  impl_->MoveTo(robot, config_);
}

void ObstacleMap::KeepNear(const Eigen::Vector3d& position, double distance_m) {
  const double block_m = kBlock * config_.voxel_m;
  const Eigen::Array3d low = (position.array() - distance_m) / block_m;
  const Eigen::Array3d high = (position.array() + distance_m) / block_m;
  impl_->tree.KeepBox(kBlock * low.floor().cast<int>().matrix(),
                      kBlock * high.ceil().cast<int>().matrix());
}

InsertReport ObstacleMap::Insert(Sensor sensor, const std::vector<Point>& points,
                                 const Pose& T_odom_sensor) {
  const SensorModelConfig& model = sensor == Sensor::kLidar ? config_.lidar : config_.depth;
  InsertReport report;
  report.points = points.size();
  const double scale = 1.0 / config_.voxel_m;
  const Eigen::Vector3d origin = scale * T_odom_sensor.translation();
  ScanMarks& marks = impl_->marks;
  report.refused = !T_odom_sensor.matrix().allFinite() || !marks.Contains(origin);
  if (report.refused) return report;
  marks.Restart();
  constexpr double kFurthest_m = 1e4;
  RayReach reach(model, impl_->scans[static_cast<std::size_t>(sensor)]++);
  for (const Point& point : points) {
    const double reach_m = reach.Next();
    const Eigen::Vector3d in_sensor = InSensor(point);
    const double range_m = in_sensor.norm();
    if (!(range_m < kFurthest_m)) {
      ++report.invalid;
    } else if (range_m < model.min_range_m) {
      ++report.too_near;
    } else {
      const Eigen::Vector3d end = scale * (T_odom_sensor * in_sensor);
      const bool marks_voxel = range_m <= model.mark_range_m && marks.Contains(end);
      if (marks_voxel) marks.AddHit(end);
      ++(marks_voxel ? report.marked : report.only_clear);
      const double cleared = std::min(1.0, reach_m / range_m);
      marks.AddRay(origin, origin + cleared * (end - origin));
    }
  }
  marks.Finish();
  impl_->tree.Apply(marks, ModelOf(model, sensor));
  return report;
}

ObstacleMap::State ObstacleMap::StateAt(const Eigen::Vector3d& position) const {
  if (!impl_->tree.InReach(position / config_.voxel_m)) return State::kUnknown;
  const HeightNode* node = impl_->tree.search(position.x(), position.y(), position.z());
  if (node == nullptr) return State::kUnknown;
  return impl_->tree.isNodeOccupied(node) ? State::kOccupied : State::kFree;
}

void ObstacleMap::Visit(const Eigen::Vector3i& low, const Eigen::Vector3i& high,
                        const std::function<void(const VoxelView&)>& visit) const {
  impl_->tree.Visit(low, high, visit);
}

Eigen::Vector3i ObstacleMap::VoxelOf(const Eigen::Vector3d& position) const {
  constexpr double kFurthest = 1e8;
  const Eigen::Array3d cell = (position / config_.voxel_m).array().floor();
  return cell.max(-kFurthest).min(kFurthest).cast<int>();
}

std::size_t ObstacleMap::node_count() const { return impl_->tree.size(); }

void ObstacleMap::WriteBinary(const std::string& path) const {
  std::ostringstream bytes;
  impl_->tree.writeBinaryConst(bytes);
  WriteFile(path, {bytes.str()});
}

}  // namespace hv::navigation
