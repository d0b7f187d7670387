#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>

#include "hv_core/file_io.h"
#include "map_manifest.h"
#include "small_map.h"

namespace hv {
namespace {

namespace fs = std::filesystem;

/// Damages bytes the ways files get damaged, and the ways that hostile ones are made.
class Mutator {
 public:
  explicit Mutator(std::uint32_t seed) : random_(seed) {}

  std::string Mutate(std::string bytes) {
    for (int changes = 1 + Below(4); changes > 0; --changes) MutateOnce(bytes);
    return bytes;
  }

 private:
  int Below(std::size_t count) { return static_cast<int>(random_() % count); }
  std::size_t Position(const std::string& bytes) { return random_() % (bytes.size() + 1); }

  void MutateOnce(std::string& bytes) {
    const std::size_t at = Position(bytes);
    const std::size_t length = std::min(bytes.size() - at, std::size_t{1} + random_() % 64);
    switch (Below(8)) {
      case 0:
        bytes.resize(at);
        break;
      case 1:
        bytes.erase(at, length);
        break;
      case 2:
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 3:
        bytes.insert(at, std::string(1 + random_() % 8, static_cast<char>(random_())));
        break;
      case 4:
        ReplaceNumber(bytes, at);
        break;
      case 5:
        bytes.replace(at, length, std::string(length, '\xff'));
        break;
      default:
        if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << Below(8)));
    }
  }

  /// Puts an extreme number in place of the next one in the text.
  void ReplaceNumber(std::string& bytes, std::size_t at) {
    static const char* kNumbers[] = {
        "0",          "-1",  "1",  "4294967295",   "4294967296",
        "1e400",      "nan", "-0", "65536",        "18446744073709551615",
        "2147483647", "inf", "3",  "1099511627776"};
    const std::size_t first = bytes.find_first_of("0123456789", at);
    if (first == std::string::npos) return;
    const std::size_t last = std::min(bytes.find_first_not_of("0123456789", first), bytes.size());
    bytes.replace(first, last - first, kNumbers[random_() % std::size(kNumbers)]);
  }

  std::mt19937 random_;
};

/// Runs `read` on damaged copies of `good`: it must return or throw InputError, nothing else.
int CountReadable(const std::string& good, std::uint32_t seed, int cases,
                  const std::function<void(const std::string&)>& read) {
  Mutator mutator(seed);
  int readable = 0;
  for (int i = 0; i < cases; ++i) {
    const std::string bytes = mutator.Mutate(good);
    try {
      read(bytes);
      ++readable;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  return readable;
}

void ExpectFinite(const PointCloud& cloud) {
  for (const Point& point : cloud.points) {
    ASSERT_TRUE(std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z));
    ASSERT_TRUE(std::isfinite(point.intensity));
  }
  ASSERT_TRUE(cloud.sensor_origin.allFinite());
}

class MapFuzz : public testing::Test {
 protected:
  void SetUp() override {
    SaveSmallMap(path_, folder_ / "work", 1);
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path_)) {
      if (entry.is_regular_file()) files_.push_back(entry.path());
    }
    std::sort(files_.begin(), files_.end());
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "map";
  std::vector<std::string> files_;
};

/// Whatever happens to one file of a map, it shows.
TEST_F(MapFuzz, DamageToAnyFileOfAMapIsFound) {
  ASSERT_EQ(files_.size(), 10U);
  Mutator mutator(11);
  for (const std::string& file : files_) {
    const std::string good = ReadFile(file);
    for (int i = 0; i < 150; ++i) {
      const std::string bytes = mutator.Mutate(good);
      WriteFile(file, {bytes});
      const std::string error = ErrorOf([this] { MapFolder::Open(path_).Verify(); });
      EXPECT_EQ(error.empty(), bytes == good) << file;
    }
    WriteFile(file, {good});
  }
  MapFolder::Open(path_).Verify();
}

TEST_F(MapFuzz, PointCloudsOfEveryFormat) {
  const std::vector<Point> points = RandomPoints(12, 3);
  WritePcd(folder_ / "a.pcd", points, PcdEncoding::kBinary);
  WritePcd(folder_ / "b.pcd", points, PcdEncoding::kCompressed);
  WritePly(folder_ / "c.ply", points);
  std::vector<std::string> goods;
  for (const char* name : {"a.pcd", "b.pcd", "c.ply"}) goods.push_back(ReadFile(folder_ / name));
  goods.emplace_back(
      "VERSION 0.7\nFIELDS x y z i\nSIZE 4 4 8 1\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n1 2 3 4\n5 6 7 8\n");
  goods.emplace_back(
      "ply\nformat ascii 1.0\nelement camera 1\nproperty float a\nelement vertex 2\n"
      "property float x\nproperty float y\nproperty float z\nend_header\n1\n1 2 3\n4 5 6\n");
  for (std::size_t i = 0; i < goods.size(); ++i) {
    const int readable = CountReadable(
        goods[i], static_cast<std::uint32_t>(i), 2000,
        [](const std::string& bytes) { ExpectFinite(ParsePointCloud(bytes, "fuzz")); });
    EXPECT_GT(readable, 50);
  }
}

/// Readers must hold even where the sums agree, as in a file made to do harm.
TEST_F(MapFuzz, GraphsGridsPosesAndManifestsWithMatchingSums) {
  CountReadable(ReadFile(path_ + "/graph.g2o"), 21, 2000,
                [](const std::string& bytes) { ParseG2o(bytes, "fuzz"); });
  CountReadable(ReadFile(path_ + "/poses.tum"), 22, 1000,
                [](const std::string& bytes) { ParseTum(bytes, "fuzz"); });
  const std::string yaml = ReadFile(path_ + "/grid.yaml");
  const std::string pgm = ReadFile(path_ + "/grid.pgm");
  CountReadable(yaml, 23, 2000,
                [&pgm](const std::string& bytes) { ParseGrid(bytes, "fuzz", pgm, "pgm"); });
  CountReadable(pgm, 24, 2000,
                [&yaml](const std::string& bytes) { ParseGrid(yaml, "yaml", bytes, "fuzz"); });
  const std::string manifest = ReadFile(path_ + "/manifest.yaml");
  const std::string body = manifest.substr(0, manifest.rfind("manifest_sha256"));
  CountReadable(body, 25, 2000, [](const std::string& bytes) {
    ParseManifest(bytes + "\nmanifest_sha256: " + Sha256(bytes + "\n") + "\n", "fuzz");
  });
}

}  // namespace
}  // namespace hv
