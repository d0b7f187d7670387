#include "point_fields.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "hv_core/error.h"

namespace hv {
namespace {

template <typename T>
double Load(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

double LoadSwapped(const PointField& field, const char* bytes);

double LoadNumber(const PointField& field, const char* bytes) {
  if (field.big_endian) return LoadSwapped(field, bytes);
  if (field.type == 'F') return field.size == 4 ? Load<float>(bytes) : Load<double>(bytes);
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? Load<std::int8_t>(bytes) : Load<std::uint8_t>(bytes);
    case 2:
      return is_signed ? Load<std::int16_t>(bytes) : Load<std::uint16_t>(bytes);
    case 4:
      return is_signed ? Load<std::int32_t>(bytes) : Load<std::uint32_t>(bytes);
    default:
      return is_signed ? Load<std::int64_t>(bytes) : Load<std::uint64_t>(bytes);
  }
}

double LoadSwapped(const PointField& field, const char* bytes) {
  char swapped[8];
  std::reverse_copy(bytes, bytes + field.size, swapped);
  PointField native = field;
  native.big_endian = false;
  return LoadNumber(native, swapped);
}

bool EqualIgnoringCase(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  });
}

/// Index of the first field called one of `names`, -1 when there is none.
int Find(const std::vector<PointField>& fields, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (EqualIgnoringCase(fields[i].name, name)) return static_cast<int>(i);
    }
  }
  return -1;
}

/// Where the values of one field lie in a binary body; empty for a field that does not exist.
struct Channel {
  const PointField* field = nullptr;
  const char* first = nullptr;
  std::size_t stride = 0;

  float At(std::size_t index) const {
    if (field == nullptr) return 0.0F;
    return static_cast<float>(LoadNumber(*field, first + index * stride));
  }
};

Channel MakeChannel(std::string_view body, std::size_t count, const std::vector<PointField>& fields,
                    PointLayout layout, int index) {
  if (index < 0) return {};
  std::size_t offset = 0;
  for (int i = 0; i < index; ++i) offset += fields[static_cast<std::size_t>(i)].bytes();
  const PointField& field = fields[static_cast<std::size_t>(index)];
  if (layout == PointLayout::kRows) return {&field, body.data() + offset, RowBytes(fields)};
  return {&field, body.data() + offset * count, field.bytes()};
}

void AddPoint(float x, float y, float z, float intensity, PointCloud& cloud) {
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) {
    ++cloud.dropped;
    return;
  }
  Point point;
  point.x = x;
  point.y = y;
  point.z = z;
  point.intensity = std::isfinite(intensity) ? intensity : 0.0F;
  cloud.points.push_back(point);
}

/// Position of each field's first value among the words of a line.
std::vector<std::size_t> WordPositions(const std::vector<PointField>& fields) {
  std::vector<std::size_t> positions;
  std::size_t position = 0;
  for (const PointField& field : fields) {
    positions.push_back(position);
    position += field.count;
  }
  positions.push_back(position);
  return positions;
}

}  // namespace

bool IsNumber(const PointField& field) {
  if (field.type == 'F') return field.size == 4 || field.size == 8;
  const bool whole = field.type == 'I' || field.type == 'U';
  return whole && (field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8);
}

PointFieldIndices FindFields(const std::vector<PointField>& fields, const std::string& source) {
  PointFieldIndices found;
  found.x = Find(fields, {"x"});
  found.y = Find(fields, {"y"});
  found.z = Find(fields, {"z"});
  found.intensity = Find(fields, {"intensity", "scalar_intensity", "i"});
  for (const int index : {found.x, found.y, found.z}) {
    if (index < 0) throw InputError(source + ": has no fields x, y and z");
    if (fields[static_cast<std::size_t>(index)].count != 1) {
      throw InputError(source + ": x, y and z must be single values");
    }
  }
  return found;
}

void DecodeBinary(std::string_view body, std::size_t count, const std::vector<PointField>& fields,
                  PointLayout layout, const std::string& source, PointCloud& cloud) {
  const PointFieldIndices indices = FindFields(fields, source);
  const Channel x = MakeChannel(body, count, fields, layout, indices.x);
  const Channel y = MakeChannel(body, count, fields, layout, indices.y);
  const Channel z = MakeChannel(body, count, fields, layout, indices.z);
  const Channel intensity = MakeChannel(body, count, fields, layout, indices.intensity);
  cloud.has_intensity = indices.intensity >= 0;
  cloud.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    AddPoint(x.At(i), y.At(i), z.At(i), intensity.At(i), cloud);
  }
}

void DecodeAscii(std::string_view body, std::size_t count, const std::vector<PointField>& fields,
                 std::size_t first_line, const std::string& source, PointCloud& cloud) {
  const PointFieldIndices indices = FindFields(fields, source);
  const std::vector<std::size_t> positions = WordPositions(fields);
  cloud.has_intensity = indices.intensity >= 0;
  LineReader lines(body);
  std::string_view line;
  for (std::size_t i = 0; i < count;) {
    if (!lines.Next(line)) {
      throw InputError(source + ": ends after " + std::to_string(i) + " of " +
                       std::to_string(count) + " points");
    }
    const std::vector<std::string_view> words = SplitWords(line);
    if (words.empty()) continue;
    ++i;
    bool good = words.size() == positions.back();
    const auto value = [&](int index) {
      double parsed = 0.0;
      if (!good || index < 0) return 0.0F;
      good = ParseDecimal(words[positions[static_cast<std::size_t>(index)]], parsed);
      return static_cast<float>(parsed);
    };
    const float x = value(indices.x);
    const float y = value(indices.y);
    const float z = value(indices.z);
    const float intensity = value(indices.intensity);
    if (!good) {
      throw InputError(source + ":" + std::to_string(first_line + lines.number() - 1) +
                       ": expected " + std::to_string(positions.back()) + " numbers");
    }
    AddPoint(x, y, z, intensity, cloud);
  }
}

std::size_t RowBytes(const std::vector<PointField>& fields) {
  std::size_t bytes = 0;
  for (const PointField& field : fields) bytes += field.bytes();
  return bytes;
}

bool LineReader::Next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++number_;
  return true;
}

std::vector<std::string_view> SplitWords(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r\v\f";
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

bool ParseCount(std::string_view word, std::size_t& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

bool ParseDecimal(std::string_view word, double& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace hv
