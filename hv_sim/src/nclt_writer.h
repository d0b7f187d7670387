#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "hv_sim/dataset_writers.h"

namespace hv::sim {

/// The files of one session of the NCLT data set; see MakeDatasetWriter().
class NcltWriter : public DatasetWriter {
 public:
  NcltWriter(const Recording& recording, const std::string& directory);

  void Write(const SensorMessage& message) override;
  void Finish() override;
  std::vector<std::string> files() const override;

 private:
  void WriteHits(const Scan& scan);
  void WriteSync(Time stamp, const Scan& scan) const;
  void WriteImu(const SensorMessage& message, const ImuSample& sample);
  void WriteGroundTruth() const;

  const Recording& recording_;
  std::string directory_;
  std::ofstream hits_;
  std::ofstream imu_;
};

}  // namespace hv::sim
