#include "hv_replay/csv_log.h"

#include "hv_core/error.h"

namespace hv::replay {

CsvLog::CsvLog(const std::string& path, const std::string& header)
    : file_(std::fopen(path.c_str(), "w")) {
  if (file_ == nullptr) throw InputError(path + ": cannot be written");
  Append(header);
}

CsvLog::~CsvLog() { std::fclose(file_); }

void CsvLog::Append(const std::string& row) {
  std::fprintf(file_, "%s\n", row.c_str());
  std::fflush(file_);
}

}  // namespace hv::replay
