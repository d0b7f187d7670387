#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <limits>
#include <thread>

#include "small_map.h"

namespace hv {
namespace {

namespace fs = std::filesystem;

/// The variant of the map at `path`; throws when it is not whole.
std::uint32_t VariantOf(const std::string& path) {
  const MapFolder map = MapFolder::Open(path);
  map.Verify();
  const std::string text = map.ReadDescriptors();
  EXPECT_EQ(map.manifest().configuration, "variant: " + text.substr(12) + "\n");
  const auto variant = static_cast<std::uint32_t>(std::stoul(text.substr(12)));
  EXPECT_EQ(map.ReadCloud().points.size(), 50U + variant);
  EXPECT_EQ(map.KeyframeIds().size(), 3U);
  return variant;
}

std::size_t CountStages(const std::string& folder) {
  std::size_t count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    count += entry.path().filename().string().rfind(".map.", 0) == 0 ? 1 : 0;
  }
  return count;
}

/// Saves larger and larger variants until killed.
[[noreturn]] void SaveForever(const std::string& path, const std::string& scratch,
                              std::uint32_t variant, MapWriterOptions options) {
  for (;; ++variant) SaveSmallMap(path, scratch, variant, options);
}

/// Seconds that the quickest of a few saves took; the map is then variant 0.
double QuickestSave(const std::string& path, const std::string& scratch, MapWriterOptions options) {
  double quickest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 5; ++i) {
    const auto start = std::chrono::steady_clock::now();
    SaveSmallMap(path, scratch, 0, options);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    quickest = std::min(quickest, elapsed.count());
  }
  return quickest;
}

/// Kills writers at moments spread over up to three saves, however fast the machine is.
void KillWhileSaving(bool exchange) {
  const TemporaryFolder folder;
  const std::string path = folder / "map";
  const MapWriterOptions options{exchange};
  const double one_save_s = QuickestSave(path, folder / "work", options);
  std::mt19937 random(exchange ? 1 : 2);
  std::uniform_real_distribution<double> saves(0.0, 3.0);
  std::uint32_t last = 0;
  for (int round = 0; round < 120; ++round) {
    const pid_t child = ::fork();
    if (child == 0) SaveForever(path, folder / "work", last + 1, options);
    std::this_thread::sleep_for(std::chrono::duration<double>(saves(random) * one_save_s));
    ::kill(child, SIGKILL);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    const std::uint32_t variant = VariantOf(path);
    ASSERT_GE(variant, last);
    last = variant;
  }
  EXPECT_GT(last, 0U);
  SaveSmallMap(path, folder / "work", last + 1, options);
  EXPECT_EQ(VariantOf(path), last + 1);
  EXPECT_EQ(CountStages(folder.path()), 0U);
}

TEST(MapCrash, KilledAtAnyMomentTheMapIsTheOldOrTheNewOne) { KillWhileSaving(true); }

TEST(MapCrash, KilledAtAnyMomentWithoutAtomicExchangeEither) { KillWhileSaving(false); }

/// Runs `body` in a process of its own; returns its exit status.
int RunApart(const std::function<int()>& body) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(body());
  int status = -1;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

constexpr int kNotPermitted = 77;

/// Mounts a RAM disk at `path`, seen by this process only.
bool MountSmallDisk(const std::string& path) {
  const int spaces = ::geteuid() == 0 ? CLONE_NEWNS : CLONE_NEWNS | CLONE_NEWUSER;
  return ::unshare(spaces) == 0 &&
         ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         ::mount("tmpfs", path.c_str(), "tmpfs", 0, "size=192k") == 0;
}

/// Saves with ever more free space until it succeeds. 0 when each failure left the old map alone.
int SaveOnFullDisk(const std::string& disk, const std::string& scratch) {
  if (!MountSmallDisk(disk)) return kNotPermitted;
  const std::string path = disk + "/map";
  SaveSmallMap(path, scratch, 1);
  int failures = 0;
  for (std::size_t free_pages = 0; free_pages < 40; ++free_pages) {
    std::ofstream filler(disk + "/filler", std::ios::binary);
    while (filler << std::string(4096, 'f') && filler.flush()) {
    }
    filler.close();
    const std::size_t pages = fs::file_size(disk + "/filler") / 4096;
    fs::resize_file(disk + "/filler", 4096 * (pages - std::min(pages, free_pages)));
    const std::string error = ErrorOf([&] { SaveSmallMap(path, scratch, 2); });
    if (VariantOf(path) != (error.empty() ? 2U : 1U) || CountStages(disk) != 0) return 1;
    if (error.empty()) return failures > 3 ? 0 : 2;
    ++failures;
    fs::remove(disk + "/filler");
  }
  return 3;
}

TEST(MapCrash, AFullDiskIsAnErrorAndLeavesTheOldMap) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "disk");
  const int status = RunApart([&] { return SaveOnFullDisk(folder / "disk", folder / "work"); });
  if (status == kNotPermitted) GTEST_SKIP() << "not permitted to mount a small disk";
  EXPECT_EQ(status, 0);
}

int SaveOnReadOnlyDisk(const std::string& disk, const std::string& scratch) {
  if (!MountSmallDisk(disk)) return kNotPermitted;
  SaveSmallMap(disk + "/map", scratch, 1);
  if (::mount("none", disk.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr) != 0) {
    return kNotPermitted;
  }
  const std::string error = ErrorOf([&] { SaveSmallMap(disk + "/map", scratch, 2); });
  if (error.find("cannot be written (Read-only file system)") == std::string::npos) return 1;
  return VariantOf(disk + "/map") == 1 ? 0 : 2;
}

TEST(MapCrash, AReadOnlyDiskIsAnErrorAndLeavesTheOldMap) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "disk");
  const int status = RunApart([&] { return SaveOnReadOnlyDisk(folder / "disk", folder / "work"); });
  if (status == kNotPermitted) GTEST_SKIP() << "not permitted to mount a disk";
  EXPECT_EQ(status, 0);
}

TEST(MapCrash, AFileThatMayNotGrowIsAnErrorAndLeavesTheOldMap) {
  const TemporaryFolder folder;
  const std::string path = folder / "map";
  SaveSmallMap(path, folder / "work", 1);
  EXPECT_EQ(RunApart([&] {
              ::signal(SIGXFSZ, SIG_IGN);
              const rlimit limit{700, 700};
              ::setrlimit(RLIMIT_FSIZE, &limit);
              const std::string error = ErrorOf([&] { SaveSmallMap(path, folder / "work", 2); });
              return error.find("cannot be written (File too large)") == std::string::npos ? 1 : 0;
            }),
            0);
  EXPECT_EQ(VariantOf(path), 1U);
  EXPECT_EQ(CountStages(folder.path()), 0U);
}

}  // namespace
}  // namespace hv
