#include "hv_explore_sac/exploration_map.h"

#include <algorithm>
#include <filesystem>

#include "hv_core/error.h"
#include "hv_core/file_io.h"

namespace hv::explore {
namespace {

namespace fs = std::filesystem;

std::vector<ExplorationMap> ReadFolder(const std::string& folder) {
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string extension = entry.path().extension();
    if (extension == ".png" || extension == ".pgm") files.push_back(entry.path());
  }
  if (files.empty()) throw InputError(folder + ": holds no PNG or PGM file");
  std::sort(files.begin(), files.end());
  std::vector<ExplorationMap> maps;
  for (const std::string& file : files) maps.push_back(ReadImageMap(file));
  return maps;
}

}  // namespace

int ExplorationMap::CountFree() const {
  return static_cast<int>(std::count_if(free.begin(), free.end(), [](char is) { return is != 0; }));
}

std::vector<ExplorationMap> ReadExplorationMaps(const std::string& path) {
  if (fs::is_directory(path)) return ReadFolder(path);
  const std::string extension = fs::path(path).extension();
  if (extension == ".yaml" || extension == ".yml") return {ReadGridMap(path)};
  if (extension == ".png" || extension == ".pgm") return {ReadImageMap(path)};
  return ParseTiles(ReadFile(path), path);
}

}  // namespace hv::explore
