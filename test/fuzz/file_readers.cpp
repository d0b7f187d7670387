#include <filesystem>

#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include "hv_core/config.h"
#include "hv_core/file_io.h"
#include "hv_core/occupancy_grid.h"
#include "hv_core/point_cloud_file.h"
#include "hv_core/pose_graph_file.h"
#include "hv_core/trajectory.h"
#include "hv_explore_sac/exploration_map.h"
#include "hv_explore_sac/policy/policy_network.h"
#include "hv_explore_sac/train/curve.h"
#include "hv_loop_btc/submap_file.h"
#include "hv_relocalize_ndt/ndt_cache.h"
#include "hv_replay/curve_plot.h"
#include "hv_replay/kitti.h"
#include "hv_replay/nclt.h"
#include "hv_replay/slam_config.h"
#include "hv_sim/faults.h"
#include "hv_sim/floor_plan.h"
#include "readers.h"

namespace hv::fuzz {
namespace {

constexpr char kSource[] = "input";

/// A file with the bytes, for readers that take a path.
class File {
 public:
  File(const std::string& bytes, const std::string& extension)
      : path_("/dev/shm/hv_fuzz_" + std::to_string(getpid()) + extension) {
    WriteFile(path_, {bytes});
  }
  ~File() { std::filesystem::remove(path_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

template <typename Read>
Reader OfFile(const std::string& extension, Read read) {
  return [=](const std::string& bytes) { read(File(bytes, extension).path()); };
}

/// Text and picture of a grid, parted by a line of its own.
void ReadGridOf(const std::string& bytes) {
  const std::size_t at = bytes.find(kGridParts);
  if (at == std::string::npos) return;
  ParseGrid(bytes.substr(0, at), kSource, bytes.substr(at + sizeof(kGridParts) - 1), kSource);
}

void ReadHits(const std::string& path) {
  replay::nclt::HitsReader reader(path);
  replay::nclt::SweepBuilder sweeps;
  while (auto packet = reader.Next()) sweeps.Add(*packet);
  sweeps.Finish();
}

void ReadSettings(const std::string& bytes) {
  replay::SlamConfig config;
  ReadConfig(ParseYaml(bytes, kSource), kSource, config);
}

/// The sum is made anew: a wrong one would end every trial before anything is read.
std::string Sealed(const std::string& bytes) { return bytes + Sha256(bytes); }

void ReadPolicy(const std::string& bytes) {
  explore::PolicyNetwork::Read(File(Sealed(bytes), ".bin").path());
}

void ReadLevels(const std::string& bytes) {
  relocalize::ParseLevels(Sealed(bytes), kNdtKey, kSource);
}

}  // namespace

Readers FileReaders() {
  return {
      {"config", ReadSettings},
      {"curve", OfFile(".csv", [](const std::string& path) { explore::ReadCurve(path); })},
      {"curve_panels",
       OfFile(".csv", [](const std::string& path) { replay::ReadCurvePanels(path); })},
      {"descriptors", [](const std::string& bytes) { loop::ParseSubmaps(bytes, kSource); }},
      {"fault", [](const std::string& bytes) { sim::ParseFault(bytes); }},
      {"floor_plan", OfFile(".yaml", [](const std::string& path) { sim::ReadFloorPlan(path); })},
      {"graph", [](const std::string& bytes) { ParseG2o(bytes, kSource); }},
      {"grid", ReadGridOf},
      {"image_map", OfFile(".png", [](const std::string& path) { explore::ReadImageMap(path); })},
      {"kitti_calibration",
       OfFile(".txt", [](const std::string& path) { replay::kitti::ReadCalibration(path); })},
      {"kitti_poses",
       OfFile(".txt", [](const std::string& path) { replay::kitti::ReadPoses(path); })},
      {"kitti_scan", OfFile(".bin",
                            [](const std::string& path) {
                              bool truncated = false;
                              replay::kitti::ReadScan(path, truncated);
                            })},
      {"kitti_times",
       OfFile(".txt", [](const std::string& path) { replay::kitti::ReadTimes(path); })},
      {"nclt_hits", OfFile(".bin", ReadHits)},
      {"nclt_imu", OfFile(".csv",
                          [](const std::string& path) {
                            bool truncated = false;
                            replay::nclt::ReadMs25(path, truncated);
                          })},
      {"nclt_truth",
       OfFile(".csv", [](const std::string& path) { replay::nclt::ReadGroundTruth(path); })},
      {"ndt_levels", ReadLevels},
      {"policy", ReadPolicy},
      {"point_cloud", [](const std::string& bytes) { ParsePointCloud(bytes, kSource); }},
      {"tiles", [](const std::string& bytes) { explore::ParseTiles(bytes, kSource); }},
      {"trajectory", [](const std::string& bytes) { ParseTum(bytes, kSource); }},
  };
}

}  // namespace hv::fuzz
