#include <sstream>

#include "hv_core/error.h"
#include "hv_core/one_line.h"
#include "hv_explore_sac/exploration_map.h"

namespace hv::explore {
namespace {

constexpr int kMostTiles = 1000;

/// Reads one block after the other, counting lines for messages.
class TilesReader {
 public:
  TilesReader(const std::string& text, const std::string& source) : text_(text), source_(source) {
    Advance();
  }

  bool AtEnd() const { return !more_; }

  ExplorationMap Next() {
    ExplorationMap map = ReadHead();
    while (more_ && !IsHead()) {
      AppendRow(map);
      Advance();
    }
    Finish(map);
    return map;
  }

 private:
  bool IsHead() const { return line_.rfind("map ", 0) == 0; }

  /// To the next line that is neither empty nor a comment: comments are "# text", rows have none.
  void Advance() {
    do {
      more_ = static_cast<bool>(std::getline(text_, line_));
      ++number_;
      if (!line_.empty() && line_.back() == '\r') line_.pop_back();
    } while (more_ && (line_.empty() || line_.rfind("# ", 0) == 0));
  }

  ExplorationMap ReadHead() {
    if (!IsHead()) Fail("expected a line `map NAME START_X START_Y`");
    std::istringstream words(line_.substr(4));
    ExplorationMap map;
    if (!(words >> map.name >> map.start.x() >> map.start.y())) {
      Fail("expected `map NAME START_X START_Y`");
    }
    Advance();
    return map;
  }

  void AppendRow(ExplorationMap& map) {
    const int tiles = static_cast<int>(line_.size());
    if (tiles > kMostTiles || map.height >= kMostTiles * kTileCells) Fail("more than 1000 tiles");
    if (map.width == 0) map.width = kTileCells * tiles;
    if (map.width != kTileCells * tiles) {
      Fail("has " + std::to_string(tiles) + " tiles where the rows before have " +
           std::to_string(map.width / kTileCells));
    }
    std::vector<char> row;
    for (const char tile : line_) {
      if (tile != '.' && tile != '#' && tile != 'S')
        Fail(std::string("unknown tile `") + tile + "`");
      row.insert(row.end(), kTileCells, tile == '#' ? 0 : 1);
    }
    for (int i = 0; i < kTileCells; ++i) map.free.insert(map.free.end(), row.begin(), row.end());
    map.height += kTileCells;
  }

  void Finish(const ExplorationMap& map) const {
    if (map.height == 0) Fail("map " + map.name + " has no rows");
    if (!map.Contains(map.start) || !map.IsFree(map.IndexOf(map.start))) {
      Fail("map " + map.name + " starts where nothing is free");
    }
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(OneLine(source_ + ", line " + std::to_string(number_) + ": " + what));
  }

  std::istringstream text_;
  std::string source_;
  std::string line_;
  int number_ = 0;
  bool more_ = true;
};

}  // namespace

std::vector<ExplorationMap> ParseTiles(const std::string& text, const std::string& source) {
  TilesReader reader(text, source);
  std::vector<ExplorationMap> maps;
  while (!reader.AtEnd()) maps.push_back(reader.Next());
  if (maps.empty()) throw InputError(source + ": holds no map");
  return maps;
}

}  // namespace hv::explore
