#include "hv_replay/result_files.h"

#include <filesystem>
#include <fstream>

#include "hv_core/error.h"

namespace hv::replay {

std::string CreateDirectory(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw InputError(path + ": cannot be created (" + error.message() + ")");
  return path;
}

void WriteText(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw InputError(path + ": cannot be written");
}

}  // namespace hv::replay
