#include "ground_grid.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace hv::loop {
namespace {

using Eigen::Vector2i;
using Eigen::Vector3d;

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr double kHighestSensor_m = 3.0;  ///< above the ground
constexpr double kLowestSensor_m = 0.15;
constexpr double kFallbackSensor_m = 0.5;  ///< when nothing below the sensor was ever seen
constexpr double kSearchRadius_m = 1.5;    ///< around the sensor
constexpr float kStepDown_m = 0.1F;        ///< between neighbouring cells
constexpr float kStepUp_m = 0.08F;

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

int FloorDivide(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

}  // namespace

GroundGrid::GroundGrid(const VoxelSpace& space, const std::vector<Vector3d>& sensor_positions)
    : space_(space) {
  ChooseFrame();
  SortColumns();
  ground_.assign(static_cast<std::size_t>(size_.prod()), kUnknown);
  measured_.assign(ground_.size(), false);
  const std::vector<Seed> seeds = FindSeeds(sensor_positions);
  if (seeds.empty()) return;
  Grow({seeds.front()});
  GrowAgain(ElsewhereSeeds(seeds));
}

void GroundGrid::ChooseFrame() {
  Vector2i low = Vector2i::Constant(std::numeric_limits<int>::max());
  Vector2i high = Vector2i::Constant(std::numeric_limits<int>::min());
  for (const auto& block : space_.blocks()) {
    if (block->free.none()) continue;
    low = low.cwiseMin(block->index.head<2>() * Block::kSide);
    high = high.cwiseMax((block->index.head<2>().array() + 1).matrix() * Block::kSide);
  }
  if (low.x() > high.x()) return;
  const auto cells = [&](int scale) {
    const Eigen::Vector2d size = (high - low).cast<double>() / scale;
    return (size.x() + 2.0) * (size.y() + 2.0);
  };
  while (cells(voxels_per_cell_) > static_cast<double>(kMaxCells)) ++voxels_per_cell_;
  for (int axis = 0; axis < 2; ++axis) {
    low_[axis] = FloorDivide(low[axis], voxels_per_cell_);
    size_[axis] = FloorDivide(high[axis] - 1, voxels_per_cell_) + 1 - low_[axis];
  }
}

Vector2i GroundGrid::CellOf(int voxel_x, int voxel_y) const {
  return Vector2i(FloorDivide(voxel_x, voxels_per_cell_), FloorDivide(voxel_y, voxels_per_cell_)) -
         low_;
}

bool GroundGrid::Contains(const Vector2i& cell) const {
  return (cell.array() >= 0).all() && (cell.array() < size_.array()).all();
}

/// Heights of surfaces by cell: counted, then filled in.
void GroundGrid::SortColumns() {
  column_begin_.assign(static_cast<std::size_t>(size_.prod()) + 1, 0);
  for (const Surface& surface : space_.surfaces()) {
    const Vector2i cell = CellOf(surface.voxel.x(), surface.voxel.y());
    if (Contains(cell)) ++column_begin_[Index(cell) + 1];
  }
  for (std::size_t i = 1; i < column_begin_.size(); ++i) column_begin_[i] += column_begin_[i - 1];
  column_heights_.resize(column_begin_.back());
  std::vector<std::uint32_t> next(column_begin_.begin(), column_begin_.end() - 1);
  for (const Surface& surface : space_.surfaces()) {
    const Vector2i cell = CellOf(surface.voxel.x(), surface.voxel.y());
    if (!Contains(cell)) continue;
    column_heights_[next[Index(cell)]++] = static_cast<float>(space_.MeanOf(surface).z());
  }
  for (std::size_t i = 0; i + 1 < column_begin_.size(); ++i) {
    std::sort(column_heights_.begin() + column_begin_[i],
              column_heights_.begin() + column_begin_[i + 1]);
  }
}

/// Median over the cells around of the lowest surface below the sensor; NaN without any.
float GroundGrid::GroundNear(const Vector3d& sensor) const {
  const double cell_m = space_.voxel_m() * voxels_per_cell_;
  const int radius = static_cast<int>(std::ceil(kSearchRadius_m / cell_m));
  const Vector2i center = (sensor.head<2>() / cell_m).array().floor().cast<int>().matrix() - low_;
  std::vector<double> lowest;
  for (int dy = -radius; dy <= radius; ++dy) {
    for (int dx = -radius; dx <= radius; ++dx) {
      const Vector2i cell = center + Vector2i(dx, dy);
      if (!Contains(cell)) continue;
      const auto begin = column_heights_.begin() + column_begin_[Index(cell)];
      const auto end = column_heights_.begin() + column_begin_[Index(cell) + 1];
      const auto found =
          std::lower_bound(begin, end, static_cast<float>(sensor.z() - kHighestSensor_m));
      if (found != end && *found < sensor.z() - kLowestSensor_m) lowest.push_back(*found);
    }
  }
  return lowest.empty() ? kUnknown : static_cast<float>(Median(lowest));
}

/// The ground under each sensor position. Where it is out of line with the height at which the
/// sensor is carried, that height counts.
std::vector<GroundGrid::Seed> GroundGrid::FindSeeds(const std::vector<Vector3d>& sensors) const {
  constexpr double kOutOfLine_m = 0.3;
  std::vector<double> heights;
  std::vector<float> grounds;
  for (const Vector3d& sensor : sensors) {
    grounds.push_back(GroundNear(sensor));
    if (!std::isnan(grounds.back())) heights.push_back(sensor.z() - grounds.back());
  }
  const double height = heights.empty() ? kFallbackSensor_m : Median(heights);
  const double cell_m = space_.voxel_m() * voxels_per_cell_;
  std::vector<Seed> seeds;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const double expected = sensors[i].z() - height;
    const bool in_line = std::abs(grounds[i] - expected) < kOutOfLine_m;
    const Vector2i cell = (sensors[i].head<2>() / cell_m).array().floor().cast<int>().matrix();
    seeds.push_back({cell - low_, in_line ? grounds[i] : static_cast<float>(expected)});
  }
  return seeds;
}

/// Positions of the sensor whose ground is not what was grown there, and where nothing was measured
/// at the height that was grown: ramps, and places that only they lead to. A floor above one that
/// was seen is not among them.
std::vector<GroundGrid::Seed> GroundGrid::ElsewhereSeeds(const std::vector<Seed>& seeds) const {
  constexpr float kSameFloor_m = 0.5F;
  std::vector<Seed> elsewhere;
  for (const Seed& seed : seeds) {
    if (!Contains(seed.cell) || measured_[Index(seed.cell)]) continue;
    const bool differs = !(std::abs(ground_[Index(seed.cell)] - seed.height) < kSameFloor_m);
    if (differs) elsewhere.push_back(seed);
  }
  return elsewhere;
}

/// Forgets heights that were not measured, and grows them once more with additional seeds.
void GroundGrid::GrowAgain(const std::vector<Seed>& seeds) {
  if (seeds.empty()) return;
  std::vector<Seed> all = seeds;
  for (int y = 0; y < size_.y(); ++y) {
    for (int x = 0; x < size_.x(); ++x) {
      const Vector2i cell(x, y);
      float& height = ground_[Index(cell)];
      if (measured_[Index(cell)]) all.push_back({cell, height});
      height = kUnknown;
    }
  }
  Grow(all);
}

/// Breadth first over neighbouring cells, so that each cell is reached on a shortest way.
void GroundGrid::Grow(const std::vector<Seed>& seeds) {
  std::deque<Vector2i> front;
  for (const Seed& seed : seeds) {
    if (!Contains(seed.cell) || !std::isnan(ground_[Index(seed.cell)])) continue;
    Visit(seed.cell, seed.height);
    front.push_back(seed.cell);
  }
  while (!front.empty()) {
    const Vector2i cell = front.front();
    front.pop_front();
    for (const Vector2i& step :
         {Vector2i(1, 0), Vector2i(0, 1), Vector2i(-1, 0), Vector2i(0, -1)}) {
      const Vector2i neighbour = cell + step;
      if (!Contains(neighbour) || !std::isnan(ground_[Index(neighbour)])) continue;
      Visit(neighbour, MeanAround(neighbour, ground_[Index(cell)]));
      front.push_back(neighbour);
    }
  }
}

/// Takes the lowest surface near the height that the cells before lead to, else that height.
void GroundGrid::Visit(const Vector2i& cell, float from_neighbours) {
  const std::size_t index = Index(cell);
  const auto begin = column_heights_.begin() + column_begin_[index];
  const auto end = column_heights_.begin() + column_begin_[index + 1];
  const auto found = std::lower_bound(begin, end, from_neighbours - kStepDown_m);
  measured_[index] = found != end && *found < from_neighbours + kStepUp_m;
  ground_[index] = measured_[index] ? *found : from_neighbours;
}

/// Mean ground of the cells around that belong to the same floor as a neighbour of this height.
float GroundGrid::MeanAround(const Vector2i& cell, float neighbour) const {
  constexpr int kRadius = 1;
  constexpr float kSameFloor_m = 0.2F;
  float sum = 0.0F;
  float count = 0.0F;
  for (int dy = -kRadius; dy <= kRadius; ++dy) {
    for (int dx = -kRadius; dx <= kRadius; ++dx) {
      const Vector2i near = cell + Vector2i(dx, dy);
      if (!Contains(near)) continue;
      const float height = ground_[Index(near)];
      if (!(std::abs(height - neighbour) < kSameFloor_m)) continue;
      sum += height;
      count += 1.0F;
    }
  }
  return sum / count;
}

float GroundGrid::HeightAt(const Vector3d& position) const {
  const double cell_m = space_.voxel_m() * voxels_per_cell_;
  const Vector2i cell = (position.head<2>() / cell_m).array().floor().cast<int>().matrix() - low_;
  return Contains(cell) ? ground_[Index(cell)] : kUnknown;
}

OccupancyGrid GroundGrid::MakeGrid(const MapBuilderConfig& config) const {
  OccupancyGrid grid;
  grid.resolution_m = space_.voxel_m() * voxels_per_cell_;
  grid.origin = low_.cast<double>() * grid.resolution_m;
  grid.width = size_.x();
  grid.height = size_.y();
  grid.cells.assign(ground_.size(), OccupancyGrid::kUnknown);
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    if (measured_[i]) grid.cells[i] = OccupancyGrid::kFree;
  }
  for (const auto& block : space_.blocks()) MarkFree(*block, config, grid);
  for (const Surface& surface : space_.surfaces()) {
    const Vector2i cell = CellOf(surface.voxel.x(), surface.voxel.y());
    if (surface.moving || !Contains(cell)) continue;
    const double above = space_.MeanOf(surface).z() - ground_[Index(cell)];
    if (above < config.obstacle_min_m || above > config.obstacle_max_m) continue;
    grid.cells[Index(cell)] = OccupancyGrid::kOccupied;
  }
  return grid;
}

/// Cells where a ray passed at the height of obstacles.
void GroundGrid::MarkFree(const Block& block, const MapBuilderConfig& config,
                          OccupancyGrid& grid) const {
  if (block.free.none()) return;
  const VoxelIndex corner = block.index * Block::kSide;
  for (int i = 0; i < Block::kSide * Block::kSide; ++i) {
    const int x = i % Block::kSide;
    const int y = i / Block::kSide;
    const Vector2i cell = CellOf(corner.x() + x, corner.y() + y);
    if (!Contains(cell) || std::isnan(ground_[Index(cell)])) continue;
    for (int z = 0; z < Block::kSide; ++z) {
      const double above = (corner.z() + z + 0.5) * space_.voxel_m() - ground_[Index(cell)];
      if (above < config.obstacle_min_m || above > config.obstacle_max_m) continue;
      if (block.free.test(Block::Bit(x, y, z))) grid.cells[Index(cell)] = OccupancyGrid::kFree;
    }
  }
}

}  // namespace hv::loop
