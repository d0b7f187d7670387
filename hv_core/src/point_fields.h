#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "hv_core/point_cloud_file.h"

namespace hv {

/// One field of the points of a file, as its header describes it.
struct PointField {
  std::string name;
  char type = 'F';          ///< I signed, U unsigned, F floating
  std::size_t size = 4;     ///< of one value [bytes]
  std::size_t count = 1;    ///< values a point
  bool big_endian = false;  ///< of binary values

  std::size_t bytes() const { return size * count; }
};

/// False for combinations of type and size that do not exist.
bool IsNumber(const PointField& field);

/// Which fields hold what is kept; `intensity` is -1 when there is none.
struct PointFieldIndices {
  int x = -1;
  int y = -1;
  int z = -1;
  int intensity = -1;
};

/// Throws InputError when x, y or z is missing or not a single number.
PointFieldIndices FindFields(const std::vector<PointField>& fields, const std::string& source);

/// How the values of a binary body are laid out.
enum class PointLayout {
  kRows,    ///< all fields of the first point, then of the second
  kColumns  ///< the first field of all points, then the second
};

/// Decodes `count` points; the caller has made sure that `body` is long enough.
void DecodeBinary(std::string_view body, std::size_t count, const std::vector<PointField>& fields,
                  PointLayout layout, const std::string& source, PointCloud& cloud);

/// Decodes `count` lines of numbers between blanks; blank lines do not count. `first_line` is the
/// number of the first one in the file. Throws InputError naming the line.
void DecodeAscii(std::string_view body, std::size_t count, const std::vector<PointField>& fields,
                 std::size_t first_line, const std::string& source, PointCloud& cloud);

/// Bytes of a point.
std::size_t RowBytes(const std::vector<PointField>& fields);

/// Walks over the lines of a text without copying it.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}

  /// False at the end. The line comes without its end ("\n" or "\r\n").
  bool Next(std::string_view& line);
  std::string_view rest() const { return rest_; }
  std::size_t number() const { return number_; }  ///< of the last line, from 1

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// Words between blanks.
std::vector<std::string_view> SplitWords(std::string_view line);

/// Whole number without sign; false when `word` is anything else or too large.
bool ParseCount(std::string_view word, std::size_t& value);

/// Any decimal number, also nan and inf; false when `word` is anything else.
bool ParseDecimal(std::string_view word, double& value);

/// The point formats; `bytes` is the whole file.
PointCloud ParsePcd(std::string_view bytes, const std::string& source);
PointCloud ParsePly(std::string_view bytes, const std::string& source);

}  // namespace hv
