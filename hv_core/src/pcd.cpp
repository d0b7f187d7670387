#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <map>

#include <lzf.h>

#include "fail.h"
#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "point_fields.h"

namespace hv {
namespace {

constexpr std::size_t kMaxFields = 256;
constexpr std::size_t kMaxFieldCount = 100000;
constexpr std::size_t kMaxRowBytes = std::size_t{1} << 20U;
constexpr std::size_t kMaxPoints = std::size_t{1} << 40U;

/// Header of a PCD: its lines by their keyword, and what they mean.
struct PcdHeader {
  std::map<std::string, std::vector<std::string_view>> entries;
  std::vector<PointField> fields;
  std::size_t count = 0;
  std::string encoding;
  std::string_view body;
  std::size_t body_line = 1;
};

bool IsKeyword(const std::string& word) {
  for (const char* known : {"VERSION", "FIELDS", "COLUMNS", "SIZE", "TYPE", "COUNT", "WIDTH",
                            "HEIGHT", "VIEWPOINT", "POINTS", "DATA"}) {
    if (word == known) return true;
  }
  return false;
}

void ReadEntries(std::string_view bytes, const std::string& source, PcdHeader& header) {
  LineReader lines(bytes);
  std::string_view line;
  while (header.entries.count("DATA") == 0) {
    if (!lines.Next(line)) Fail(source, "PCD header has no DATA line");
    std::vector<std::string_view> words = SplitWords(line);
    if (words.empty() || words[0].front() == '#') continue;
    const std::string keyword(words[0].substr(0, 20));
    if (!IsKeyword(keyword)) Fail(source, "neither a PCD nor a PLY file, or its header is damaged");
    words.erase(words.begin());
    if (!header.entries.emplace(keyword, std::move(words)).second) {
      Fail(source, "PCD header gives " + keyword + " twice");
    }
  }
  header.body = lines.rest();
  header.body_line = lines.number() + 1;
}

/// The words of a line that must have one word a field; empty when the line is not there.
const std::vector<std::string_view>& PerField(const PcdHeader& header, const std::string& keyword,
                                              const std::string& source) {
  static const std::vector<std::string_view> kNone;
  const auto found = header.entries.find(keyword);
  if (found == header.entries.end()) return kNone;
  if (found->second.size() != header.fields.size()) {
    Fail(source, "PCD header has " + std::to_string(header.fields.size()) + " fields, but " +
                     std::to_string(found->second.size()) + " entries in " + keyword);
  }
  return found->second;
}

void ReadFields(const std::string& source, PcdHeader& header) {
  const char* keyword = header.entries.count("FIELDS") != 0 ? "FIELDS" : "COLUMNS";
  for (const std::string_view name : header.entries[keyword]) {
    header.fields.emplace_back();
    header.fields.back().name = name;
  }
  if (header.fields.empty() || header.fields.size() > kMaxFields) {
    Fail(source, "PCD header names no fields, or too many");
  }
  const std::vector<std::string_view>& sizes = PerField(header, "SIZE", source);
  const std::vector<std::string_view>& types = PerField(header, "TYPE", source);
  const std::vector<std::string_view>& counts = PerField(header, "COUNT", source);
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    PointField& field = header.fields[i];
    bool good = sizes.empty() || ParseCount(sizes[i], field.size);
    good = good && (counts.empty() || ParseCount(counts[i], field.count));
    if (!types.empty()) field.type = types[i].size() == 1 ? types[i].front() : '?';
    if (!good || !IsNumber(field) || field.count < 1 || field.count > kMaxFieldCount) {
      Fail(source, "PCD header describes field '" + field.name.substr(0, 40) + "' wrongly");
    }
  }
  if (RowBytes(header.fields) > kMaxRowBytes) Fail(source, "PCD header has too large points");
}

/// A line that holds one whole number; `absent` when it is missing.
std::size_t CountEntry(const PcdHeader& header, const std::string& keyword, std::size_t absent,
                       const std::string& source) {
  const auto found = header.entries.find(keyword);
  if (found == header.entries.end()) return absent;
  std::size_t value = 0;
  if (found->second.size() != 1 || !ParseCount(found->second[0], value) || value > kMaxPoints) {
    Fail(source, "PCD header has a bad " + keyword);
  }
  return value;
}

void ReadCounts(const std::string& source, PcdHeader& header) {
  constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();
  const std::size_t points = CountEntry(header, "POINTS", kAbsent, source);
  const std::size_t height = CountEntry(header, "HEIGHT", 1, source);
  const std::size_t width = CountEntry(header, "WIDTH", points, source);
  if (width == kAbsent) Fail(source, "PCD header has neither WIDTH nor POINTS");
  if (height != 0 && width > kMaxPoints / height) Fail(source, "PCD header has a bad WIDTH");
  header.count = width * height;
  if (points != kAbsent && points != header.count) {
    Fail(source, "PCD header has WIDTH x HEIGHT different from POINTS");
  }
}

Eigen::Vector3f ReadOrigin(const PcdHeader& header, const std::string& source) {
  const auto found = header.entries.find("VIEWPOINT");
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  if (found == header.entries.end()) return origin.cast<float>();
  bool good = found->second.size() == 7;
  for (int i = 0; good && i < 3; ++i) {
    good = ParseDecimal(found->second[static_cast<std::size_t>(i)], origin[i]);
  }
  if (!good || !origin.cast<float>().allFinite()) Fail(source, "PCD header has a bad VIEWPOINT");
  return origin.cast<float>();
}

PcdHeader ReadPcdHeader(std::string_view bytes, const std::string& source) {
  PcdHeader header;
  ReadEntries(bytes, source, header);
  ReadFields(source, header);
  ReadCounts(source, header);
  const std::vector<std::string_view>& data = header.entries["DATA"];
  header.encoding = data.size() == 1 ? std::string(data[0]) : "";
  return header;
}

void RequireBody(const PcdHeader& header, std::size_t bytes_per_point, const std::string& source) {
  if (header.count <= header.body.size() / bytes_per_point) return;
  Fail(source, "is cut short: the header promises " + std::to_string(header.count) + " points, " +
                   std::to_string(header.body.size()) + " bytes of them are there");
}

std::uint32_t LoadU32(std::string_view bytes) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data(), sizeof(value));
  return value;
}

/// The columns of a compressed body. Fields called "_" are padding and not stored.
std::string Decompress(const PcdHeader& header, const std::string& source) {
  if (header.count == 0) return "";
  if (header.body.size() < 8) Fail(source, "is cut short: its points are missing");
  const std::size_t compressed = LoadU32(header.body);
  const std::size_t size = LoadU32(header.body.substr(4));
  if (compressed > header.body.size() - 8) Fail(source, "is cut short within its points");
  // Three bytes of LZF stand for at most 264.
  if (size != header.count * RowBytes(header.fields) || size / 88 > compressed) {
    Fail(source, "compressed points do not have the size that the header promises");
  }
  std::string columns(size, '\0');
  const unsigned int written =
      lzf_decompress(header.body.data() + 8, static_cast<unsigned int>(compressed), columns.data(),
                     static_cast<unsigned int>(size));
  if (written != size) Fail(source, "compressed points are damaged");
  return columns;
}

void DropPadding(std::vector<PointField>& fields) {
  std::vector<PointField> kept;
  for (const PointField& field : fields) {
    if (field.name != "_") kept.push_back(field);
  }
  fields = std::move(kept);
}

/// Values of all points as rows or as columns.
std::string PackPoints(const std::vector<Point>& points, PointLayout layout) {
  std::string body(points.size() * 4 * sizeof(float), '\0');
  const std::size_t row = layout == PointLayout::kRows ? 4 : 1;
  const std::size_t column = layout == PointLayout::kRows ? 1 : points.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float values[4] = {points[i].x, points[i].y, points[i].z, points[i].intensity};
    for (std::size_t k = 0; k < 4; ++k) {
      std::memcpy(&body[(i * row + k * column) * sizeof(float)], &values[k], sizeof(float));
    }
  }
  return body;
}

std::string PcdHeaderText(std::size_t count, const Eigen::Vector3f& origin, const char* encoding) {
  char text[400];
  std::snprintf(text, sizeof(text),
                "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
                "FIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
                "WIDTH %zu\nHEIGHT 1\nVIEWPOINT %.9g %.9g %.9g 1 0 0 0\nPOINTS %zu\nDATA %s\n",
                count, static_cast<double>(origin.x()), static_cast<double>(origin.y()),
                static_cast<double>(origin.z()), count, encoding);
  return text;
}

/// Sizes, then compressed columns. Empty when the points are too many for the format.
std::string CompressedBody(const std::vector<Point>& points) {
  constexpr std::size_t kLargest = std::numeric_limits<std::uint32_t>::max();
  if (points.empty() || points.size() > kLargest / 32) return "";
  const std::string columns = PackPoints(points, PointLayout::kColumns);
  std::string body(8 + columns.size() + columns.size() / 16 + 64, '\0');
  const std::uint32_t size = static_cast<std::uint32_t>(columns.size());
  const std::uint32_t compressed = lzf_compress(columns.data(), size, body.data() + 8,
                                                static_cast<unsigned int>(body.size() - 8));
  if (compressed == 0) return "";
  std::memcpy(body.data(), &compressed, 4);
  std::memcpy(body.data() + 4, &size, 4);
  body.resize(8 + compressed);
  return body;
}

}  // namespace

PointCloud ParsePcd(std::string_view bytes, const std::string& source) {
  PcdHeader header = ReadPcdHeader(bytes, source);
  PointCloud cloud;
  cloud.sensor_origin = ReadOrigin(header, source);
  if (header.encoding == "ascii") {
    RequireBody(header, 2 * header.fields.size() - 1, source);
    DecodeAscii(header.body, header.count, header.fields, header.body_line, source, cloud);
  } else if (header.encoding == "binary") {
    RequireBody(header, RowBytes(header.fields), source);
    DecodeBinary(header.body, header.count, header.fields, PointLayout::kRows, source, cloud);
  } else if (header.encoding == "binary_compressed") {
    DropPadding(header.fields);
    FindFields(header.fields, source);
    const std::string columns = Decompress(header, source);
    DecodeBinary(columns, header.count, header.fields, PointLayout::kColumns, source, cloud);
  } else {
    Fail(source, "DATA must be ascii, binary or binary_compressed");
  }
  return cloud;
}

void WritePcd(const std::string& path, const std::vector<Point>& points, PcdEncoding encoding,
              const Eigen::Vector3f& sensor_origin) {
  const std::string compressed =
      encoding == PcdEncoding::kCompressed ? CompressedBody(points) : std::string();
  if (!compressed.empty()) {
    WriteFile(path, {PcdHeaderText(points.size(), sensor_origin, "binary_compressed"), compressed});
  } else {
    WriteFile(path, {PcdHeaderText(points.size(), sensor_origin, "binary"),
                     PackPoints(points, PointLayout::kRows)});
  }
}

}  // namespace hv
