#include <cstring>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "hall.h"
#include "hv_core/point_cloud_decoder.h"
#include "hv_lio/scan_preprocessor.h"
#include "hv_lio/scan_update.h"
#include "hv_lio/thread_arena.h"
#include "hv_lio/voxel_map.h"

namespace hv::lio {
namespace {

constexpr std::uint32_t kHesaiPointBytes = 26;
constexpr int kMapScans = 30;

/// The first sweep in the layout of the Hesai driver: x y z intensity (f32), timestamp (f64), ring.
std::vector<std::uint8_t> HesaiBytes(const Scan& scan) {
  std::vector<std::uint8_t> bytes(scan.points.size() * kHesaiPointBytes);
  std::uint8_t* to = bytes.data();
  for (const Point& point : scan.points) {
    const float values[4] = {point.x, point.y, point.z, point.intensity};
    const double stamp = scan.stamp.seconds() + static_cast<double>(point.time);
    std::memcpy(to, values, sizeof(values));
    std::memcpy(to + 16, &stamp, sizeof(stamp));
    std::memcpy(to + 24, &point.ring, sizeof(point.ring));
    to += kHesaiPointBytes;
  }
  return bytes;
}

PointCloudView HesaiView(const Scan& scan, const std::vector<std::uint8_t>& bytes) {
  PointCloudView view;
  view.stamp = scan.stamp;
  view.fields = {{"x", 0, FieldType::kFloat32},          {"y", 4, FieldType::kFloat32},
                 {"z", 8, FieldType::kFloat32},          {"intensity", 12, FieldType::kFloat32},
                 {"timestamp", 16, FieldType::kFloat64}, {"ring", 24, FieldType::kUint16}};
  view.width = static_cast<std::uint32_t>(scan.points.size());
  view.height = 1;
  view.point_step = kHesaiPointBytes;
  view.row_step = kHesaiPointBytes * view.width;
  view.data = bytes.data();
  view.size = bytes.size();
  return view;
}

/// Motion of the IMU, which shares the LiDAR's frame, in knots of 2.5 ms.
ScanMotion MotionOf(double start) {
  ScanMotion motion;
  motion.end_time = 0.1;
  for (int i = 0; i < 40; ++i) {
    MotionKnot knot;
    knot.time = 0.0025 * i;
    const Pose pose = Hall::PoseAt(start + knot.time);
    knot.position = pose.translation();
    knot.rotation = pose.linear();
    knot.velocity = Eigen::Vector3d(1.0, 0.0, 0.0);
    knot.angular_velocity = Eigen::Vector3d(0.0, 0.0, 0.5);
    motion.knots.push_back(knot);
  }
  return motion;
}

PreprocessConfig CellsOf(double size_m) {
  PreprocessConfig config;
  config.cell_size_m = size_m;
  return config;
}

/// Cells of one sweep at its end.
std::vector<SurfaceCell> CellsAt(double start, double size_m, Hall& hall) {
  const std::vector<Point> points = Deskew(hall.Sweep(start), MotionOf(start), Pose::Identity());
  return CellGrid(CellsOf(size_m)).Group(points, Eigen::Vector3d::Zero());
}

/// A map of three seconds in the hall.
VoxelMap FilledMap(double size_m, Hall& hall) {
  VoxelMap map{VoxelMapConfig()};
  for (int i = 0; i < kMapScans; ++i) {
    map.Insert(CellsAt(0.1 * i, size_m, hall), Hall::PoseAt(0.1 * (i + 1)));
  }
  return map;
}

double CellSize(const benchmark::State& state) {
  return 0.01 * static_cast<double>(state.range(0));
}

void Decode(benchmark::State& state) {
  Hall hall;
  const Scan scan = hall.Sweep(0.0);
  const std::vector<std::uint8_t> bytes = HesaiBytes(scan);
  const PointCloudView view = HesaiView(scan, bytes);
  PointCloudDecoder decoder{PointCloudDecoderConfig()};
  for (auto _ : state) benchmark::DoNotOptimize(decoder.Decode(view));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scan.points.size()));
}
BENCHMARK(Decode)->Unit(benchmark::kMillisecond);

void DeskewScan(benchmark::State& state) {
  Hall hall;
  ThreadArena arena(1);
  const Scan scan = hall.Sweep(0.0);
  const ScanMotion motion = MotionOf(0.0);
  arena.Execute([&] {
    for (auto _ : state) benchmark::DoNotOptimize(Deskew(scan, motion, Pose::Identity()));
  });
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scan.points.size()));
}
BENCHMARK(DeskewScan)->Unit(benchmark::kMillisecond);

void GroupCells(benchmark::State& state) {
  Hall hall;
  const Scan scan = hall.Sweep(0.0);
  CellGrid grid(CellsOf(CellSize(state)));
  std::size_t cells = 0;
  for (auto _ : state) cells = grid.Group(scan.points, Eigen::Vector3d::Zero()).size();
  state.counters["cells"] = static_cast<double>(cells);
}
BENCHMARK(GroupCells)->Unit(benchmark::kMillisecond)->ArgName("cell_cm")->Arg(25)->Arg(50);

void MapInsert(benchmark::State& state) {
  Hall hall;
  const VoxelMap filled = FilledMap(CellSize(state), hall);
  const std::vector<SurfaceCell> cells = CellsAt(0.1 * kMapScans, CellSize(state), hall);
  const Pose T_odom_imu = Hall::PoseAt(0.1 * (kMapScans + 1));
  for (auto _ : state) {
    state.PauseTiming();
    VoxelMap map = filled;
    state.ResumeTiming();
    map.Insert(cells, T_odom_imu);
    state.PauseTiming();
    benchmark::DoNotOptimize(map.size());
    state.ResumeTiming();
  }
  state.counters["cells"] = static_cast<double>(cells.size());
}
BENCHMARK(MapInsert)->Unit(benchmark::kMillisecond)->ArgName("cell_cm")->Arg(25)->Arg(50);

void MapFind(benchmark::State& state) {
  Hall hall;
  const VoxelMap map = FilledMap(0.5, hall);
  const Pose T_odom_imu = Hall::PoseAt(0.1 * (kMapScans + 1));
  std::vector<Eigen::Vector3d> points;
  for (const SurfaceCell& cell : CellsAt(0.1 * kMapScans, 0.5, hall)) {
    points.push_back(T_odom_imu * cell.mean);
  }
  std::size_t found = 0;
  for (auto _ : state) {
    found = 0;
    for (const Eigen::Vector3d& point : points) found += map.Find(point) != nullptr ? 1U : 0U;
    benchmark::DoNotOptimize(found);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(points.size());
}
BENCHMARK(MapFind)->Unit(benchmark::kMicrosecond);

void Update(benchmark::State& state) {
  Hall hall;
  ThreadArena arena(1);
  const VoxelMap map = FilledMap(CellSize(state), hall);
  const std::vector<SurfaceCell> cells = CellsAt(0.1 * kMapScans, CellSize(state), hall);
  const ScanUpdate update{UpdateConfig()};
  const Pose truth = Hall::PoseAt(0.1 * (kMapScans + 1));
  UpdateSummary summary;
  arena.Execute([&] {
    for (auto _ : state) {
      NavState prior;
      prior.position = truth.translation() + Eigen::Vector3d(0.02, -0.01, 0.005);
      prior.rotation = truth.linear() * RotationFromRpy(0.002, -0.001, 0.003);
      ErrorMatrix covariance = 1e-3 * ErrorMatrix::Identity();
      summary = update.Apply(cells, map, false, prior, covariance);
    }
  });
  state.counters["residuals"] = static_cast<double>(summary.residuals);
  state.counters["iterations"] = summary.iterations;
}
BENCHMARK(Update)->Unit(benchmark::kMillisecond)->ArgName("cell_cm")->Arg(25)->Arg(50);

}  // namespace
}  // namespace hv::lio

BENCHMARK_MAIN();
