#include "hv_core/point_cloud_file.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "small_map.h"

namespace hv {
namespace {

void ExpectEqual(const std::vector<Point>& a, const std::vector<Point>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].x, b[i].x);
    ASSERT_EQ(a[i].y, b[i].y);
    ASSERT_EQ(a[i].z, b[i].z);
    ASSERT_EQ(a[i].intensity, b[i].intensity);
  }
}

const char* kAsciiPcd =
    "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS normal_x x y z intensity\n"
    "SIZE 4 4 8 4 1\nTYPE F F F F U\nCOUNT 2 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
    "VIEWPOINT 1 2 3 1 0 0 0\nPOINTS 2\nDATA ascii\n";

TEST(PointCloudFile, EveryFormatReadsBackExactly) {
  const TemporaryFolder folder;
  for (const std::size_t count : {0, 1, 3, 1000}) {
    const std::vector<Point> points = RandomPoints(count, 7);
    const Eigen::Vector3f origin(0.25F, -1.0F / 3.0F, 7.0F);
    WritePcd(folder / "a.pcd", points, PcdEncoding::kBinary, origin);
    WritePcd(folder / "b.pcd", points, PcdEncoding::kCompressed, origin);
    WritePly(folder / "c.ply", points);
    for (const char* name : {"a.pcd", "b.pcd", "c.ply"}) {
      const PointCloud cloud = ReadPointCloud(folder / name);
      ExpectEqual(cloud.points, points);
      EXPECT_TRUE(cloud.has_intensity);
      EXPECT_EQ(cloud.dropped, 0U);
      EXPECT_EQ(cloud.sensor_origin, name[0] == 'c' ? Eigen::Vector3f(0.0F, 0.0F, 0.0F) : origin);
    }
  }
}

TEST(PointCloudFile, CompressionShrinksRegularClouds) {
  const TemporaryFolder folder;
  std::vector<Point> points(5000);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].x = static_cast<float>(i % 64);
  WritePcd(folder / "a.pcd", points, PcdEncoding::kCompressed);
  EXPECT_LT(std::filesystem::file_size(folder / "a.pcd"), points.size() * 4);
  ExpectEqual(ReadPointCloud(folder / "a.pcd").points, points);
}

TEST(PointCloudFile, AsciiWithOtherFieldsAndTypes) {
  const PointCloud cloud =
      ParsePointCloud(std::string(kAsciiPcd) + "9 9 1.5 -2 +3e1 200\r\n\n9 9 nan 1 2 3\n", "test");
  ASSERT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(cloud.dropped, 1U);
  EXPECT_EQ(cloud.points[0].x, 1.5F);
  EXPECT_EQ(cloud.points[0].y, -2.0F);
  EXPECT_EQ(cloud.points[0].z, 30.0F);
  EXPECT_EQ(cloud.points[0].intensity, 200.0F);
  EXPECT_EQ(cloud.sensor_origin, Eigen::Vector3f(1.0F, 2.0F, 3.0F));
}

TEST(PointCloudFile, BinaryWithPaddingDoublesAndNoIntensity) {
  std::string text =
      "VERSION .7\nFIELDS x _ y z\nSIZE 8 1 8 8\nTYPE F U F F\nCOUNT 1 4 1 1\nWIDTH 1\nHEIGHT 2\n"
      "POINTS 2\nDATA binary\n";
  for (const double value : {1.0, 2.0, 3.0, 4.0, std::nan(""), 6.0}) {
    text.append(reinterpret_cast<const char*>(&value), sizeof(value));
    if (value == 1.0 || value == 4.0) text.append(4, 'p');
  }
  const PointCloud cloud = ParsePointCloud(text, "test");
  ASSERT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(cloud.points[0].z, 3.0F);
  EXPECT_EQ(cloud.dropped, 1U);
  EXPECT_FALSE(cloud.has_intensity);
}

TEST(PointCloudFile, PlyAsciiAndBigEndianWithOtherElements) {
  const PointCloud ascii = ParsePointCloud(
      "ply\nformat ascii 1.0\ncomment made by hand\nelement camera 1\nproperty float angle\n"
      "element vertex 2\nproperty double x\nproperty float y\nproperty float z\n"
      "property uchar scalar_Intensity\nelement face 1\nproperty list uchar int vertex_indices\n"
      "end_header\n0.5\n1 2 3 4\n5 6 7 8\n3 0 1 1\n",
      "test");
  ASSERT_EQ(ascii.points.size(), 2U);
  EXPECT_EQ(ascii.points[1].x, 5.0F);
  EXPECT_EQ(ascii.points[1].intensity, 8.0F);
  std::string text =
      "ply\r\nformat binary_big_endian 1.0\r\nelement vertex 1\r\nproperty short x\r\n"
      "property short y\r\nproperty int z\r\nend_header\r\n";
  text += std::string("\x00\x05\xff\xff\x00\x00\x01\x00", 8);
  const PointCloud swapped = ParsePointCloud(text, "test");
  ASSERT_EQ(swapped.points.size(), 1U);
  EXPECT_EQ(swapped.points[0].x, 5.0F);
  EXPECT_EQ(swapped.points[0].y, -1.0F);
  EXPECT_EQ(swapped.points[0].z, 256.0F);
}

TEST(PointCloudFile, FaultsAreNamedInOneLine) {
  const std::string body = "0 0 1 2 3 4\n0 0 1 2 3 4\n";
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = kAsciiPcd + body;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  const std::pair<std::string, std::string> cases[] = {
      {"", "no DATA line"},
      {"hello world\n", "neither a PCD nor a PLY"},
      {replaced("normal_x x y", "normal_x u y"), "no fields x, y and z"},
      {replaced("COUNT 2 1 1", "COUNT 1 3 1"), "single values"},
      {replaced("COUNT 2 1 1", "COUNT 0 1 1"), "'normal_x' wrongly"},
      {replaced("SIZE 4 4 8", "SIZE 4 3 8"), "'x' wrongly"},
      {replaced("TYPE F F F", "TYPE F G F"), "'x' wrongly"},
      {replaced("SIZE 4 4 8 4 1", "SIZE 4 4 8 4"), "4 entries in SIZE"},
      {replaced("WIDTH 2", "WIDTH 3"), "different from POINTS"},
      {replaced("WIDTH 2", "WIDTH 99999999999999999999"), "bad WIDTH"},
      {replaced("HEIGHT 1", "WIDTH 2"), "WIDTH twice"},
      {replaced("VIEWPOINT 1", "VIEWPOINT nan"), "bad VIEWPOINT"},
      {replaced("DATA ascii", "DATA brotli"), "DATA must be"},
      {replaced("0 0 1 2 3 4\n0", "0 0 1 2 3\n0"), "test:12: expected 6 numbers"},
      {replaced("0 0 1 2 3 4\n0 0 1 2 3 4", "0 0 1 2 x 4\n0 0 1 2 3 4"), "test:12: expected 6"},
      {replaced("0 0 1 2 3 4\n0 0 1 2 3 4\n", "0 0 1 2.125 3 4.250000\n"), "ends after 1 of 2"},
      {replaced("DATA ascii", "DATA binary"), "cut short"},
      {replaced("DATA ascii", "DATA binary_compressed"), "cut short"},
      {"ply\nformat ascii 1.0\n", "no end_header"},
      {"ply\nformat odd 1.0\nend_header\n", "PLY format"},
      {"ply\nformat ascii 1.0\nend_header\n", "no element 'vertex'"},
      {"ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nend_header\n", "cut short"},
      {"ply\nproperty float x\nend_header\n", "before any element"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar int x\nend_header\n1 1\n",
       "lists"}};
  for (const auto& [text, expected] : cases) {
    const std::string error = ErrorOf([&text = text] { ParsePointCloud(text, "test"); });
    EXPECT_EQ(error.rfind("test:", 0), 0U) << text;
    EXPECT_NE(error.find(expected), std::string::npos) << "'" << error << "' for\n" << text;
    EXPECT_EQ(error.find('\n'), std::string::npos);
  }
}

TEST(PointCloudFile, HugePromisesAreRefusedWithoutAllocating) {
  for (const char* encoding : {"ascii", "binary", "binary_compressed"}) {
    const std::string text = std::string("FIELDS x y z\nWIDTH 1000000000\nHEIGHT 1000\nDATA ") +
                             encoding + "\n" + std::string(16, '\xff');
    EXPECT_NE(ErrorOf([&] { ParsePointCloud(text, "test"); }), "") << encoding;
  }
}

TEST(PointCloudFile, MissingFilesFoldersAndUnwritablePathsAreErrors) {
  const TemporaryFolder folder;
  EXPECT_NE(ErrorOf([] { ReadPointCloud("/nonexistent/a.pcd"); }), "");
  EXPECT_NE(ErrorOf([&] { ReadPointCloud(folder.path()); }), "");
  EXPECT_NE(ErrorOf([] { WritePcd("/nonexistent/a.pcd", {}); }), "");
  EXPECT_NE(ErrorOf([&] { WritePointCloud(folder / "a.txt", {}); }), "");
  WritePointCloud(folder / "a.ply", {});
  WritePointCloud(folder / "a.pcd", {});
}

TEST(ThinPoints, KeepsOneMeanForEachCube) {
  std::vector<Point> points(4);
  points[0].x = 0.02F;
  points[0].intensity = 10.0F;
  points[0].ring = 3;
  points[1].x = 0.06F;
  points[1].intensity = 30.0F;
  points[2].x = -0.02F;
  points[3].x = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Point> thinned = ThinPoints(points, 0.1);
  ASSERT_EQ(thinned.size(), 2U);
  EXPECT_FLOAT_EQ(thinned[0].x, 0.04F);
  EXPECT_FLOAT_EQ(thinned[0].intensity, 20.0F);
  EXPECT_EQ(thinned[0].ring, 3);
  EXPECT_FLOAT_EQ(thinned[1].x, -0.02F);
}

}  // namespace
}  // namespace hv
