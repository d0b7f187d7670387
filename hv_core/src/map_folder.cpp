#include "hv_core/map_folder.h"

#include <algorithm>
#include <filesystem>

#include "fail.h"
#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "map_manifest.h"

namespace hv {
namespace {

namespace fs = std::filesystem;

std::string WithoutTrailingSlash(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

/// The folder to read: `path`, or what an interrupted save left of it.
std::string FindFolder(const std::string& path) {
  std::error_code ignored;
  const std::string old = OldMapPathOf(path);
  return !fs::exists(path, ignored) && IsFolder(old) ? old : path;
}

bool ByName(const MapFile& file, const std::string& name) { return file.name < name; }

}  // namespace

MapFolder MapFolder::Open(const std::string& path) {
  MapFolder map;
  map.path_ = FindFolder(WithoutTrailingSlash(path));
  if (!IsFolder(map.path_)) {
    std::error_code ignored;
    if (!fs::exists(map.path_, ignored)) Fail(path, "there is no such map");
    map.is_plain_cloud_ = true;
    return map;
  }
  const std::string manifest_path = map.path_ + "/" + kManifestName;
  std::error_code ignored;
  if (!fs::exists(manifest_path, ignored)) {
    Fail(path, "is not a map: it has no " + std::string(kManifestName));
  }
  map.manifest_ = ParseManifest(ReadFile(manifest_path), manifest_path);
  map.CheckPresence();
  return map;
}

MapContents MapFolder::contents() const {
  MapContents contents;
  contents.cloud = is_plain_cloud_ || Has("cloud.pcd");
  contents.keyframes = manifest_.keyframes > 0;
  contents.graph = Has("graph.g2o");
  contents.descriptors = Has("descriptors.bin");
  contents.grid = Has("grid.yaml");
  contents.occupancy = Has("occupancy.bt");
  return contents;
}

std::vector<std::uint32_t> MapFolder::KeyframeIds() const {
  std::vector<std::uint32_t> ids;
  std::uint32_t id = 0;
  for (const MapFile& file : manifest_.files) {
    if (ParseKeyframeName(file.name, id)) ids.push_back(id);
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

PointCloud MapFolder::ReadCloud() const {
  if (is_plain_cloud_) return ReadPointCloud(path_);
  return ParsePointCloud(ReadChecked("cloud.pcd"), path_ + "/cloud.pcd");
}

PointCloud MapFolder::ReadKeyframe(std::uint32_t id) const {
  const std::string name = KeyframeFileName(id);
  return ParsePointCloud(ReadChecked(name), path_ + "/" + name);
}

PoseGraphData MapFolder::ReadGraph() const {
  return ParseG2o(ReadChecked("graph.g2o"), path_ + "/graph.g2o");
}

Trajectory MapFolder::ReadPoses() const {
  return ParseTum(ReadChecked("poses.tum"), path_ + "/poses.tum");
}

std::string MapFolder::ReadDescriptors() const { return ReadChecked("descriptors.bin"); }

OccupancyGrid MapFolder::ReadGrid() const {
  return ParseGrid(ReadChecked("grid.yaml"), path_ + "/grid.yaml", ReadChecked("grid.pgm"),
                   path_ + "/grid.pgm");
}

std::string MapFolder::OccupancyPath() const {
  VerifyFile(Find("occupancy.bt"));
  return path_ + "/occupancy.bt";
}

void MapFolder::Verify(const std::function<void(double)>& progress) const {
  if (is_plain_cloud_) {
    ReadCloud();
    return;
  }
  double done = 0.0;
  for (const MapFile& file : manifest_.files) {
    VerifyFile(file);
    done += 1.0;
    if (progress) progress(done / static_cast<double>(manifest_.files.size()));
  }
  CheckCounts();
}

bool MapFolder::Has(const std::string& name) const {
  const auto file = std::lower_bound(manifest_.files.begin(), manifest_.files.end(), name, ByName);
  return file != manifest_.files.end() && file->name == name;
}

const MapFile& MapFolder::Find(const std::string& name) const {
  if (!Has(name)) Fail(path_, "the map has no " + name);
  return *std::lower_bound(manifest_.files.begin(), manifest_.files.end(), name, ByName);
}

std::string MapFolder::ReadChecked(const std::string& name) const {
  const MapFile& file = Find(name);
  std::string bytes = ReadFile(path_ + "/" + name);
  if (bytes.size() != file.size || Sha256(bytes) != file.sha256) {
    Fail(path_ + "/" + name, "does not match its checksum in the manifest: damaged or edited");
  }
  return bytes;
}

void MapFolder::CheckPresence() const {
  for (const MapFile& file : manifest_.files) {
    std::error_code error;
    const std::string file_path = path_ + "/" + file.name;
    const std::uintmax_t size = fs::file_size(file_path, error);
    if (error) Fail(file_path, "is listed in the manifest, but " + error.message());
    if (size != file.size) {
      Fail(file_path, "has " + std::to_string(size) + " bytes, " + std::to_string(file.size) +
                          " by the manifest");
    }
  }
}

void MapFolder::VerifyFile(const MapFile& file) const {
  const std::string file_path = path_ + "/" + file.name;
  const std::string extension = fs::path(file.name).extension();
  if (extension == ".pcd") {
    ParsePointCloud(ReadChecked(file.name), file_path);
    return;
  }
  const FileSum sum = SumOfFile(file_path);
  if (sum.size != file.size || sum.sha256 != file.sha256) {
    Fail(file_path, "does not match its checksum in the manifest: damaged or edited");
  }
}

void MapFolder::CheckCounts() const {
  const MapContents has = contents();
  const std::string manifest_path = path_ + "/" + kManifestName;
  if (KeyframeIds().size() != manifest_.keyframes) {
    Fail(manifest_path, "counts " + std::to_string(manifest_.keyframes) + " keyframes, lists " +
                            std::to_string(KeyframeIds().size()));
  }
  if (has.graph) {
    ReadGraph();
    ReadPoses();
  }
  if (has.grid) ReadGrid();
}

}  // namespace hv
