#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "hv_core/imu_sample.h"
#include "hv_core/scan.h"
#include "hv_core/trajectory.h"

/// Readers of the NCLT data set (Carlevaris-Bianco, Ushani, Eustice: University of Michigan North
/// Campus long-term vision and lidar dataset, 2016). Files use a body frame with x forward, y
/// right, z down. Everything returned here is turned to x forward, y left, z up: IMU samples in the
/// frame `imu_link` at the MS25, points in the frame `velodyne` at the LiDAR with axes parallel to
/// those of `imu_link`.
namespace hv::replay::nclt {

/// Pose of `velodyne` in `imu_link`: body_T_ms25^-1 body_T_velodyne in z-up axes; its rotation is
/// the identity.
Pose T_imu_velodyne();

/// One packet of velodyne_hits.bin, or one whole file of velodyne_sync, as stored (sensor axes).
struct Packet {
  Time stamp;
  std::vector<Point> hits;  ///< time is left 0
};

/// Hits of 8 bytes each: u16 x, y, z (value * 0.005 - 100 m), u8 intensity, u8 laser. An incomplete
/// hit at the end is left out.
std::vector<Point> DecodeHits(const std::uint8_t* data, std::size_t size);

/// Reads velodyne_hits.bin packet by packet. Skips forward to the next packet where bytes are not
/// one.
class HitsReader {
 public:
  /// Throws InputError when the file cannot be opened.
  explicit HitsReader(const std::string& path);

  std::optional<Packet> Next();

  std::size_t skipped_bytes() const { return skipped_bytes_; }
  bool truncated() const { return truncated_; }  ///< the file ends inside a packet
  double fraction() const;                       ///< of the file read so far

 private:
  bool FindHeader();

  std::ifstream file_;
  std::size_t size_ = 0;
  std::size_t skipped_bytes_ = 0;
  bool truncated_ = false;
};

/// Vertical position of the frame that hits are stored in, below the LiDAR along its axis [m]: 0
/// for hits in sensor coordinates; velodyne_sync files may hold them moved to the body frame. Found
/// from the fixed elevation of each laser of the HDL-32E; nullopt when there are too few hits.
std::optional<double> VerticalShift(const std::vector<Point>& hits);

/// Turns hits of one packet or file into frame `velodyne`. `vertical_shift` as from VerticalShift;
/// shifted hits are taken as parallel to the body axes, others as in the sensor's own.
void ToVelodyneFrame(double vertical_shift, std::vector<Point>& hits);

/// Cuts the stream of packets into sweeps of one revolution, with the firing time of each point
/// from the packet's stamp and the firing order of the HDL-32E.
class SweepBuilder {
 public:
  /// Returns the finished sweep when `packet` starts a new one.
  std::optional<Scan> Add(const Packet& packet);
  /// The sweep in progress; nullopt when there is none.
  std::optional<Scan> Finish();

 private:
  bool StartsNewSweep(const Packet& packet, double azimuth) const;

  Scan sweep_;
  double last_azimuth_ = 0.0;
  Time last_stamp_;
};

/// A velodyne_sync file as a sweep: `stamp` is its first firing, times follow from the azimuth over
/// 0.1 s.
Scan SweepFromSync(Packet file);

/// Reads ms25.csv: utime, magnetometer 3, accelerometer 3 [m/s^2], gyro 3 [rad/s]. Sorted by stamp,
/// duplicates left out. Throws InputError naming the line when one is malformed, except the last
/// when the file ends inside it (`truncated` is set then).
std::vector<ImuSample> ReadMs25(const std::string& path, bool& truncated);

/// Reads groundtruth_*.csv: utime, x, y, z, roll, pitch, heading of the body, z down. Returns poses
/// of `imu_link` in a z-up world. Lines with nan are left out.
Trajectory ReadGroundTruth(const std::string& path);

}  // namespace hv::replay::nclt
