#include "hv_replay/kitti.h"

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>

#include "hv_core/error.h"

namespace hv::replay::kitti {
namespace {

constexpr std::size_t kPointBytes = 4 * sizeof(float);

[[noreturn]] void Fail(const std::string& path, const std::string& fault) {
  throw InputError(path + ": " + fault);
}

[[noreturn]] void FailAt(const std::string& path, std::size_t line, const std::string& fault) {
  Fail(path, "line " + std::to_string(line) + ": " + fault);
}

/// Calls `take` with every line that is not blank and its number, counted from 1.
void ForEachLine(const std::string& path,
                 const std::function<void(const std::string&, std::size_t)>& take) {
  std::ifstream file(path);
  if (!file) Fail(path, "cannot be read");
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) take(line, number);
  }
}

/// The numbers of `text`; empty when anything in it is not a finite number.
std::vector<double> Numbers(const std::string& text) {
  std::istringstream words(text);
  std::vector<double> numbers;
  double number = 0.0;
  while (words >> number) numbers.push_back(number);
  return words.eof() ? numbers : std::vector<double>();
}

/// The transform of twelve numbers, its rotation made orthonormal: the files round to seven digits.
Pose PoseFrom(const std::vector<double>& numbers, const std::string& path, std::size_t line) {
  if (numbers.size() != 12) FailAt(path, line, "not the twelve numbers of a 3 x 4 matrix");
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> matrix(numbers.data());
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  const Eigen::Matrix3d excess = rotation.transpose() * rotation - Eigen::Matrix3d::Identity();
  if (!(excess.norm() < 1e-2) || rotation.determinant() < 0.0) {
    FailAt(path, line, "the matrix is not a rigid transform");
  }
  return MakePose(Eigen::Quaterniond(rotation).normalized(), Eigen::Vector3d(matrix.col(3)));
}

}  // namespace

std::vector<Point> ReadScan(const std::string& path, bool& truncated) {
  std::ifstream file(path, std::ios::binary);
  if (!file) Fail(path, "cannot be read");
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  truncated = bytes.size() % kPointBytes != 0;
  std::vector<Point> points(bytes.size() / kPointBytes);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<float, 4> values{};
    std::memcpy(values.data(), bytes.data() + i * kPointBytes, kPointBytes);
    points[i].x = values[0];
    points[i].y = values[1];
    points[i].z = values[2];
    points[i].intensity = values[3];
  }
  return points;
}

Pose ReadCalibration(const std::string& path) {
  const std::string label = "Tr:";
  bool found = false;
  Pose T_cam0_velodyne = Pose::Identity();
  ForEachLine(path, [&](const std::string& line, std::size_t number) {
    if (line.compare(0, label.size(), label) != 0) return;
    T_cam0_velodyne = PoseFrom(Numbers(line.substr(label.size())), path, number);
    found = true;
  });
  if (!found) Fail(path, "no line 'Tr:' with the pose of the LiDAR in cam0");
  return T_cam0_velodyne;
}

std::vector<Pose> ReadPoses(const std::string& path) {
  std::vector<Pose> poses;
  ForEachLine(path, [&](const std::string& line, std::size_t number) {
    poses.push_back(PoseFrom(Numbers(line), path, number));
  });
  if (poses.empty()) Fail(path, "no poses");
  return poses;
}

std::vector<double> ReadTimes(const std::string& path) {
  std::vector<double> times;
  ForEachLine(path, [&](const std::string& line, std::size_t number) {
    const std::vector<double> numbers = Numbers(line);
    if (numbers.size() != 1 || !(numbers[0] >= 0.0 && numbers[0] < 1e7)) {
      FailAt(path, number, "not a time in seconds since the first scan");
    }
    if (!times.empty() && numbers[0] <= times.back()) {
      FailAt(path, number, "earlier than the line before");
    }
    times.push_back(numbers[0]);
  });
  return times;
}

}  // namespace hv::replay::kitti
