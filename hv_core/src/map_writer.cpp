#include "hv_core/map_writer.h"

#include <fcntl.h>
#include <linux/fs.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "fail.h"
#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "map_manifest.h"

namespace hv {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void FailToWrite(const fs::filesystem_error& error, const std::string& path) {
  throw InputError(path + ": cannot be written (" + error.code().message() + ")");
}

/// Exchanges two paths in one step.
bool Exchange(const std::string& a, const std::string& b) {
  return ::syscall(SYS_renameat2, AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
}

void RemoveTree(const std::string& path) {
  std::error_code ignored;
  fs::remove_all(path, ignored);
}

/// `path` without symbolic links, dots and slash at the end.
std::string Resolve(const std::string& path) {
  try {
    fs::path resolved = fs::weakly_canonical(fs::absolute(path));
    if (!resolved.has_filename()) resolved = resolved.parent_path();
    return resolved;
  } catch (const fs::filesystem_error& error) {
    FailToWrite(error, path);
  }
}

std::string StagePrefix(const std::string& target) {
  return "." + fs::path(target).filename().string() + ".part-";
}

int OpenAndLock(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return -1;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  ::close(descriptor);
  return -1;
}

void CopyEntry(const fs::path& from, const fs::path& to) {
  if (fs::is_symlink(from)) {
    fs::copy_symlink(from, to);
  } else if (fs::is_directory(from)) {
    fs::create_directories(to);
    for (const fs::directory_entry& entry : fs::directory_iterator(from)) {
      CopyEntry(entry.path(), to / entry.path().filename());
    }
  } else if (fs::is_regular_file(from)) {
    LinkOrCopy(from, to);
  }
}

}  // namespace

MapWriter::MapWriter(const std::string& path, MapWriterOptions options) : options_(options) {
  target_ = Resolve(path);
  parent_ = fs::path(target_).parent_path();
  CheckTarget();
  try {
    fs::create_directories(parent_);
    RecoverOldMap();
    RemoveStaleStages();
    MakeStage();
  } catch (const fs::filesystem_error& error) {
    FailToWrite(error, target_);
  }
}

MapWriter::~MapWriter() {
  if (!stage_.empty()) RemoveTree(stage_);
  if (lock_ >= 0) ::close(lock_);
}

void MapWriter::CheckTarget() const {
  std::error_code ignored;
  if (!fs::exists(target_, ignored)) return;
  if (!IsFolder(target_)) throw InputError(target_ + ": is a file, not a folder for a map");
  if (fs::is_empty(target_, ignored) || fs::exists(target_ + "/" + kManifestName, ignored)) return;
  throw InputError(target_ + ": holds files that are not a map; choose another folder");
}

std::string MapWriter::OldMapPath() const { return OldMapPathOf(target_); }

void MapWriter::RecoverOldMap() const {
  const std::string old = OldMapPath();
  if (!IsFolder(old)) return;
  if (fs::exists(target_)) {
    RemoveTree(old);
  } else {
    fs::rename(old, target_);
  }
}

void MapWriter::RemoveStaleStages() const {
  const std::string prefix = StagePrefix(target_);
  for (const fs::directory_entry& entry : fs::directory_iterator(parent_)) {
    const std::string name = entry.path().filename();
    if (name.compare(0, prefix.size(), prefix) != 0 || !entry.is_directory()) continue;
    const int lock = OpenAndLock(entry.path());
    if (lock < 0) continue;  // its writer is alive
    RemoveTree(entry.path());
    ::close(lock);
  }
}

void MapWriter::MakeStage() {
  constexpr int kAttempts = 10;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::string stage = parent_ + "/" + StagePrefix(target_) + "XXXXXX";
    if (::mkdtemp(stage.data()) == nullptr) Fail(target_, "cannot be written", errno);
    stage_ = stage;
    if (!LockStage()) continue;
    fs::permissions(stage_, fs::perms(0755));
    fs::create_directory(stage_ + "/keyframes");
    return;
  }
  throw InputError(target_ + ": cannot be written (another program keeps removing the folder)");
}

/// False when another writer took the new folder for a stale one before it was locked. File systems
/// without locks are used without.
bool MapWriter::LockStage() {
  lock_ = OpenAndLock(stage_);
  if (lock_ < 0) return IsFolder(stage_) && errno != EWOULDBLOCK;
  struct stat locked {};
  struct stat named {};
  if (::fstat(lock_, &locked) == 0 && ::stat(stage_.c_str(), &named) == 0 &&
      locked.st_ino == named.st_ino) {
    return true;
  }
  ::close(lock_);
  lock_ = -1;
  return false;
}

void MapWriter::AddKeyframe(std::uint32_t id, const std::string& pcd_path) {
  LinkOrCopy(pcd_path, stage_ + "/" + KeyframeFileName(id));
  ++manifest_.keyframes;
}

void MapWriter::AddGraph(const PoseGraphData& graph) {
  WriteG2o(stage_ + "/graph.g2o", graph);
  std::vector<StampedPose> poses;
  for (const GraphVertex& vertex : graph.vertices) {
    poses.push_back({vertex.stamp, vertex.T_map_imu});
  }
  WriteTum(stage_ + "/poses.tum", Trajectory(std::move(poses)));
  manifest_.loops = static_cast<std::size_t>(std::count_if(
      graph.edges.begin(), graph.edges.end(),
      [](const GraphEdge& edge) { return edge.kind == EdgeKind::kLoop && edge.accepted; }));
}

void MapWriter::AddDescriptors(std::string_view bytes) {
  WriteFile(stage_ + "/descriptors.bin", {bytes});
}

void MapWriter::AddCloud(const std::vector<Point>& points) {
  WritePcd(stage_ + "/cloud.pcd", points);
  manifest_.cloud_points = points.size();
}

void MapWriter::AddGrid(const OccupancyGrid& grid) {
  if (!grid.cells.empty()) WriteGrid(stage_, "grid", grid);
}

void MapWriter::Commit(const std::string& configuration, const std::string& frame) {
  manifest_.configuration = configuration;
  manifest_.frame = frame;
  const std::string manifest_path = stage_ + "/" + kManifestName;
  try {
    ListAndSync();
    WriteFile(manifest_path, {ManifestText(manifest_)});
    SyncPath(manifest_path);
    KeepForeignFiles();
    SyncPath(stage_ + "/keyframes");
    SyncPath(stage_);
    Swap();
    SyncPath(parent_);
  } catch (const fs::filesystem_error& error) {
    FailToWrite(error, target_);
  }
  RemoveTree(stage_);
  RemoveTree(OldMapPath());
  stage_.clear();
}

/// Lists every file of the map with its sum and flushes it to disk.
void MapWriter::ListAndSync() {
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(stage_)) {
    if (entry.is_directory()) continue;
    const FileSum sum = SumOfFile(entry.path());
    manifest_.files.push_back({fs::relative(entry.path(), stage_), sum.size, sum.sha256});
    SyncPath(entry.path());
  }
  std::sort(manifest_.files.begin(), manifest_.files.end(),
            [](const MapFile& a, const MapFile& b) { return a.name < b.name; });
}

void MapWriter::KeepForeignFiles() const {
  if (!IsFolder(target_)) return;
  for (const fs::directory_entry& entry : fs::directory_iterator(target_)) {
    const std::string name = entry.path().filename();
    if (name != "keyframes" && !IsMapFile(name)) CopyEntry(entry.path(), stage_ + "/" + name);
  }
}

/// Afterwards the new map is at the target, and the old one at the stage, or gone.
void MapWriter::Swap() {
  if (!IsFolder(target_)) {
    if (std::rename(stage_.c_str(), target_.c_str()) != 0) {
      Fail(target_, "cannot be written", errno);
    }
  } else if (!options_.exchange || !Exchange(stage_, target_)) {
    ReplaceInTwoSteps();
  }
}

void MapWriter::ReplaceInTwoSteps() {
  const std::string old = OldMapPath();
  RemoveTree(old);
  if (std::rename(target_.c_str(), old.c_str()) != 0) Fail(target_, "cannot be replaced", errno);
  if (std::rename(stage_.c_str(), target_.c_str()) == 0) return;
  const int error = errno;
  std::rename(old.c_str(), target_.c_str());
  Fail(target_, "cannot be written", error);
}

}  // namespace hv
