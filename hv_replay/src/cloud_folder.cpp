#include "hv_replay/cloud_folder.h"

#include <algorithm>
#include <filesystem>

#include "hv_core/error.h"

namespace hv::replay {

std::vector<std::string> CloudFiles(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".pcd" || extension == ".ply") files.push_back(entry.path().string());
  }
  if (error) throw InputError(folder + ": cannot be read (" + error.message() + ")");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace hv::replay
