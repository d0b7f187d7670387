#include "hv_sim/dataset_writers.h"

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "bag_writer.h"
#include "hv_core/error.h"
#include "nclt_writer.h"

namespace hv::sim {
namespace {

void WriteText(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw InputError(path + ": cannot be written");
}

std::string Calibration(const RecordingConfig& config, const Pose& T_imu_lidar) {
  const Eigen::Vector3d t = T_imu_lidar.translation();
  const Eigen::Quaterniond q(T_imu_lidar.linear());
  const ImuConfig& imu = config.suite.imu;
  std::ostringstream text;
  text << std::setprecision(12) << "# Pose of the LiDAR in the IMU frame.\n"
       << "extrinsic:\n"
       << "  translation_m: [" << t.x() << ", " << t.y() << ", " << t.z() << "]\n"
       << "  rotation_xyzw: [" << q.x() << ", " << q.y() << ", " << q.z() << ", " << q.w() << "]\n"
       << "# True errors of the IMU at " << imu.rate_hz
       << " Hz: densities per sqrt(Hz), bias walks per sqrt(s).\n"
       << "imu:\n"
       << "  gyro_noise: " << imu.gyro_noise << "\n"
       << "  accel_noise: " << imu.accel_noise << "\n"
       << "  gyro_walk: " << imu.gyro_bias_walk << "\n"
       << "  accel_walk: " << imu.accel_bias_walk << "\n";
  return text.str();
}

void Count(const SensorMessage& message, DatasetSummary& summary) {
  if (const Scan* scan = std::get_if<Scan>(&message.data)) {
    ++summary.scans;
    summary.points += static_cast<std::int64_t>(scan->points.size());
  } else {
    ++summary.imu_samples;
  }
}

}  // namespace

std::unique_ptr<DatasetWriter> MakeDatasetWriter(const Recording& recording,
                                                 const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw InputError(directory + ": cannot be made: " + error.message());
  if (recording.config().format == "nclt") {
    return std::make_unique<NcltWriter>(recording, directory);
  }
  return std::make_unique<BagWriter>(recording, directory + "/recording.bag");
}

DatasetSummary WriteDataset(const Recording& recording, const DatasetOptions& options) {
  const RecordingConfig& config = recording.config();
  const std::unique_ptr<DatasetWriter> writer = MakeDatasetWriter(recording, options.directory);
  const Time start = Time::FromSeconds(config.suite.epoch_s);
  FaultInjector injector(options.faults, start, static_cast<std::uint32_t>(config.seed) + 0xFA17U);
  DatasetSummary summary;
  std::vector<Time> scan_ends;
  const auto sink = [&](SensorMessage message) {
    if (const Scan* scan = std::get_if<Scan>(&message.data)) scan_ends.push_back(scan->end());
    if (!injector.Apply(message)) {
      ++summary.lost_messages;
      return;
    }
    Count(message, summary);
    writer->Write(message);
  };
  recording.Stream(options.threads, sink, options.progress);
  writer->Finish();

  const std::string directory = options.directory + "/";
  WriteTum(directory + "truth.tum",
           TruthUnder(options.faults, start, recording.ImuTruth(scan_ends)));
  WriteText(directory + "calibration.yaml", Calibration(config, recording.rig().T_imu_lidar()));
  WriteText(directory + "simulation.yaml", ToYaml(config));
  summary.files = writer->files();
  for (const char* name : {"truth.tum", "calibration.yaml", "simulation.yaml"}) {
    summary.files.push_back(directory + name);
  }
  for (const std::string& file : summary.files) {
    if (std::filesystem::path(file).extension() == ".bag") TruncateIfAsked(options.faults, file);
  }
  summary.path_length_m = recording.path_length();
  return summary;
}

}  // namespace hv::sim
