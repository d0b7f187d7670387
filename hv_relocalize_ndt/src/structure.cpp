#include "hv_relocalize_ndt/structure.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "hv_core/error.h"

namespace hv::relocalize {
namespace {

constexpr float kPi = 3.14159265F;
/// Cosine of a normal to the vertical beyond which a plane is level, and up to which it is a wall.
constexpr double kLevelCosine = 0.93;
constexpr double kWallCosine = 0.35;
/// Where a sensor can be: so far above a floor [m], and beside the seen part of it.
constexpr double kMostHeight_m = 2.5;
constexpr double kBeside_m = 1.0;
/// Most cubes of a grid, all levels together.
constexpr double kMostCells = 1.5e9;

int WallDirection(float azimuth) {
  const float turns = azimuth / kPi;
  const float share = turns - std::floor(turns);
  return static_cast<int>(share * kWallDirections) % kWallDirections;
}

/// A normal near the border of two directions counts as both.
StructureBits WallBits(float azimuth) {
  constexpr float kQuarterStep = 0.25F * kPi / kWallDirections;
  return static_cast<StructureBits>(
      (1U << static_cast<unsigned>(WallDirection(azimuth - kQuarterStep))) |
      (1U << static_cast<unsigned>(WallDirection(azimuth + kQuarterStep))));
}

StructureCell CellFor(const NdtVoxel& voxel, const Eigen::Matrix3f& R_level_cloud) {
  const Eigen::Vector3f normal = R_level_cloud * voxel.normal;
  StructureCell cell;
  cell.center = R_level_cloud * voxel.mean;
  cell.level = voxel.planar() && std::abs(normal.z()) > kLevelCosine;
  cell.wall = voxel.planar() && std::abs(normal.z()) < kWallCosine;
  cell.azimuth = std::atan2(normal.y(), normal.x());
  return cell;
}

StructureBits BitsOf(const StructureCell& cell) {
  if (cell.level) return kLevel;
  if (cell.wall) return WallBits(cell.azimuth);
  return kClutter;
}

}  // namespace

StructureBits StructureCell::Fits(float yaw) const {
  if (level) return kLevel;
  constexpr StructureBits kAnyWall = (1U << kWallDirections) - 1U;
  if (!wall) return kClutter | kAnyWall;
  return static_cast<StructureBits>(kClutter |
                                    (1U << static_cast<unsigned>(WallDirection(azimuth + yaw))));
}

std::vector<StructureCell> StructureCells(const NdtLevel& cloud,
                                          const Eigen::Matrix3d& R_level_cloud) {
  std::vector<StructureCell> cells;
  cells.reserve(cloud.voxels().size());
  const Eigen::Matrix3f rotation = R_level_cloud.cast<float>();
  for (const NdtVoxel& voxel : cloud.voxels()) cells.push_back(CellFor(voxel, rotation));
  return cells;
}

Eigen::Vector3d EstimateUp(const NdtLevel& cloud, const Eigen::Vector3d& guess) {
  constexpr int kIterations = 6;
  constexpr double kFirstTolerance = 0.5;  // sine of 30 deg
  constexpr double kLastTolerance = 0.1;
  Eigen::Vector3d up = guess.normalized();
  for (int i = 0; i < kIterations; ++i) {
    const double tolerance =
        kFirstTolerance + (kLastTolerance - kFirstTolerance) * i / (kIterations - 1.0);
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const NdtVoxel& voxel : cloud.voxels()) {
      if (!voxel.planar()) continue;
      const Eigen::Vector3d normal = voxel.normal.cast<double>();
      const double along = std::abs(normal.dot(up));
      const double across = std::sqrt(std::max(0.0, 1.0 - along * along));
      if (along < tolerance) spread += normal * normal.transpose();
      if (across < tolerance) spread -= normal * normal.transpose();
    }
    if (spread.isZero()) return up;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
    const Eigen::Vector3d least = solver.eigenvectors().col(0);
    up = least.dot(up) < 0.0 ? Eigen::Vector3d(-least) : least;
  }
  constexpr double kMostTurn = 0.8;  // cosine
  return up.dot(guess.normalized()) > kMostTurn ? up : guess.normalized();
}

Eigen::Matrix3d UprightRotation(const Eigen::Vector3d& up) {
  return Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

StructureGrid::StructureGrid(const NdtLevel& surfaces, int depth)
    : cell_m_(surfaces.resolution_m()), padding_(1 << (depth - 1)) {
  SetSize(surfaces);
  const double cells = padded_size_.cast<double>().prod();
  if (2.0 * cells * depth > kMostCells) {
    throw InputError("the map is too large for a search at " + std::to_string(cell_m_) + " m");
  }
  std::vector<StructureBits> finest(static_cast<std::size_t>(cells), 0);
  for (const StructureCell& cell : StructureCells(surfaces, Eigen::Matrix3d::Identity())) {
    const Eigen::Vector3i at =
        CellOf(cell.center.cast<double>()) + Eigen::Vector3i::Constant(padding_);
    finest[Index(at)] |= BitsOf(cell);
  }
  levels_ = Windows(std::move(finest), depth);
  standing_ = Windows(PlacesToStand(), depth);
}

void StructureGrid::SetSize(const NdtLevel& surfaces) {
  if (!surfaces.voxels().empty()) {
    Eigen::Vector3f low = surfaces.voxels().front().mean;
    Eigen::Vector3f high = low;
    for (const NdtVoxel& voxel : surfaces.voxels()) {
      low = low.cwiseMin(voxel.mean);
      high = high.cwiseMax(voxel.mean);
    }
    origin_ = cell_m_ * (low.cast<double>() / cell_m_).array().floor().matrix();
    size_ = CellOf(high.cast<double>()) + Eigen::Vector3i::Ones();
  }
  padded_size_ = size_ + Eigen::Vector3i::Constant(padding_);
}

Eigen::Vector3i StructureGrid::CellOf(const Eigen::Vector3d& point) const {
  constexpr double kFarthest = 1e8;
  const Eigen::Array3d cell = ((point - origin_) / cell_m_).array().floor();
  return cell.max(-kFarthest).min(kFarthest).cast<int>();
}

/// Up to kMostHeight_m above every level cube, and kBeside_m beside it, where furniture hides the
/// floor.
std::vector<StructureBits> StructureGrid::PlacesToStand() const {
  const int beside = static_cast<int>(std::ceil(kBeside_m / cell_m_));
  const int above = static_cast<int>(std::ceil(kMostHeight_m / cell_m_));
  std::vector<StructureBits> places(levels_.front().size(), 0);
  Eigen::Vector3i cell;
  for (cell.z() = 0; cell.z() < padded_size_.z(); ++cell.z()) {
    for (cell.y() = 0; cell.y() < padded_size_.y(); ++cell.y()) {
      for (cell.x() = 0; cell.x() < padded_size_.x(); ++cell.x()) {
        if ((levels_.front()[Index(cell)] & kLevel) == 0) continue;
        const Eigen::Vector3i low =
            (cell - Eigen::Vector3i(beside, beside, 0)).cwiseMax(Eigen::Vector3i::Zero());
        const Eigen::Vector3i high = (cell + Eigen::Vector3i(beside, beside, above))
                                         .cwiseMin(padded_size_ - Eigen::Vector3i::Ones());
        for (int z = low.z(); z <= high.z(); ++z) {
          for (int y = low.y(); y <= high.y(); ++y) {
            const auto row =
                places.begin() + static_cast<std::ptrdiff_t>(Index(Eigen::Vector3i(low.x(), y, z)));
            std::fill(row, row + (high.x() - low.x() + 1), StructureBits{1});
          }
        }
      }
    }
  }
  return places;
}

std::vector<std::vector<StructureBits>> StructureGrid::Windows(std::vector<StructureBits> finest,
                                                               int depth) const {
  std::vector<std::vector<StructureBits>> levels{std::move(finest)};
  for (int level = 1; level < depth; ++level) {
    levels.push_back(levels.back());
    Widen(1 << (level - 1), levels.back());
  }
  return levels;
}

/// Adds to every window those that start `step` cubes further on.
void StructureGrid::Widen(int step, std::vector<StructureBits>& grid) const {
  const std::size_t strides[3] = {
      1, static_cast<std::size_t>(padded_size_.x()),
      static_cast<std::size_t>(padded_size_.x()) * static_cast<std::size_t>(padded_size_.y())};
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t ahead = strides[axis] * static_cast<std::size_t>(step);
    Eigen::Vector3i end = padded_size_;
    end[axis] -= step;
    Eigen::Vector3i cell;
    for (cell.z() = 0; cell.z() < end.z(); ++cell.z()) {
      for (cell.y() = 0; cell.y() < end.y(); ++cell.y()) {
        for (cell.x() = 0; cell.x() < end.x(); ++cell.x()) {
          const std::size_t index = Index(cell);
          grid[index] = static_cast<StructureBits>(grid[index] | grid[index + ahead]);
        }
      }
    }
  }
}

}  // namespace hv::relocalize
