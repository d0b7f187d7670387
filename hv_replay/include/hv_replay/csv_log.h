#pragma once

#include <cstdio>
#include <string>

namespace hv::replay {

/// A CSV file that is flushed row by row, so that an interrupted run keeps its rows.
class CsvLog {
 public:
  /// Writes the header. Throws InputError when the file cannot be written.
  CsvLog(const std::string& path, const std::string& header);
  ~CsvLog();
  CsvLog(const CsvLog&) = delete;
  CsvLog& operator=(const CsvLog&) = delete;

  void Append(const std::string& row);

 private:
  std::FILE* file_;
};

}  // namespace hv::replay
