#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <stdexcept>
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

/// A process that saves larger and larger variants until killed, and tells of each save.
class Saver {
 public:
  Saver(const std::string& path, const std::string& scratch, std::uint32_t variant,
        MapWriterOptions options) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    child_ = ::fork();
    if (child_ == 0) SaveForever(path, scratch, variant, options, ends[1]);
    ::close(ends[1]);
    saved_ = ends[0];
  }
  ~Saver() {
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    ::close(saved_);
  }
  Saver(const Saver&) = delete;
  Saver& operator=(const Saver&) = delete;

  /// Waits for the next save and returns the seconds that took.
  double WaitForSave() const {
    const auto start = std::chrono::steady_clock::now();
    char byte = 0;
    EXPECT_EQ(::read(saved_, &byte, 1), 1);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    return elapsed.count();
  }

 private:
  [[noreturn]] static void SaveForever(const std::string& path, const std::string& scratch,
                                       std::uint32_t variant, MapWriterOptions options, int saved) {
    for (;; ++variant) {
      SaveSmallMap(path, scratch, variant, options);
      if (::write(saved, "s", 1) != 1) ::_exit(1);
    }
  }

  pid_t child_ = -1;
  int saved_ = -1;
};

/// Kills writers somewhere within their first, second or third save, however fast the machine is.
void KillWhileSaving(bool exchange) {
  const TemporaryFolder folder;
  const std::string path = folder / "map";
  const MapWriterOptions options{exchange};
  SaveSmallMap(path, folder / "work", 0, options);
  std::mt19937 random(exchange ? 1 : 2);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::uint32_t last = 0;
  double save_s = 0.01;
  for (int round = 0; round < 120; ++round) {
    {
      const Saver saver(path, folder / "work", last + 1, options);
      for (auto saves = random() % 3; saves > 0; --saves) save_s = saver.WaitForSave();
      std::this_thread::sleep_for(std::chrono::duration<double>(share(random) * save_s));
    }
    const std::uint32_t variant = VariantOf(path);
    ASSERT_GE(variant, last);
    last = variant;
  }
  EXPECT_GT(last, 60U);
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
