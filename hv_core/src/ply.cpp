#include <algorithm>
#include <cstdio>
#include <cstring>

#include "fail.h"
#include "hv_core/error.h"
#include "hv_core/file_io.h"
#include "point_fields.h"

namespace hv {
namespace {

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PointField> fields;
  bool has_list = false;
};

struct PlyHeader {
  std::string format;
  std::vector<PlyElement> elements;
  std::string_view body;
  std::size_t body_line = 1;
};

struct PlyType {
  const char* name;
  char type;
  std::size_t size;
};

constexpr PlyType kTypes[] = {
    {"char", 'I', 1},  {"int8", 'I', 1},    {"uchar", 'U', 1},  {"uint8", 'U', 1},
    {"short", 'I', 2}, {"int16", 'I', 2},   {"ushort", 'U', 2}, {"uint16", 'U', 2},
    {"int", 'I', 4},   {"int32", 'I', 4},   {"uint", 'U', 4},   {"uint32", 'U', 4},
    {"float", 'F', 4}, {"float32", 'F', 4}, {"double", 'F', 8}, {"float64", 'F', 8}};

void AddProperty(const std::vector<std::string_view>& words, const std::string& source,
                 PlyHeader& header) {
  if (header.elements.empty()) Fail(source, "PLY header has a property before any element");
  PlyElement& element = header.elements.back();
  if (words.size() == 5 && words[1] == "list") {
    element.has_list = true;
    return;
  }
  const auto* type = std::find_if(std::begin(kTypes), std::end(kTypes), [&words](const PlyType& t) {
    return words.size() == 3 && words[1] == t.name;
  });
  if (type == std::end(kTypes) || element.fields.size() > 256) {
    Fail(source, "PLY header has a bad property of element '" + element.name + "'");
  }
  element.fields.push_back(
      {std::string(words[2]), type->type, type->size, 1, header.format == "binary_big_endian"});
}

void AddElement(const std::vector<std::string_view>& words, const std::string& source,
                PlyHeader& header) {
  PlyElement element;
  constexpr std::size_t kMaxCount = std::size_t{1} << 40U;
  if (words.size() != 3 || !ParseCount(words[2], element.count) || element.count > kMaxCount ||
      header.elements.size() > 64) {
    Fail(source, "PLY header has a bad element");
  }
  element.name = words[1].substr(0, 40);
  header.elements.push_back(std::move(element));
}

PlyHeader ReadPlyHeader(std::string_view bytes, const std::string& source) {
  PlyHeader header;
  LineReader lines(bytes);
  std::string_view line;
  for (bool first = true;; first = false) {
    if (!lines.Next(line)) Fail(source, "PLY header has no end_header");
    const std::vector<std::string_view> words = SplitWords(line);
    if (first || words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format" && words.size() == 3) {
      header.format = words[1];
    } else if (words[0] == "element") {
      AddElement(words, source, header);
    } else if (words[0] == "property") {
      AddProperty(words, source, header);
    } else {
      Fail(source, "PLY header is damaged in line " + std::to_string(lines.number()));
    }
  }
  header.body = lines.rest();
  header.body_line = lines.number() + 1;
  return header;
}

/// Leaves out the elements before the vertices and returns the vertices.
const PlyElement& SkipToVertices(PlyHeader& header, const std::string& source) {
  const bool ascii = header.format == "ascii";
  for (const PlyElement& element : header.elements) {
    const std::size_t row = ascii ? 2 * element.fields.size() : RowBytes(element.fields);
    if (element.has_list || row == 0) Fail(source, "PLY has lists where its vertices should be");
    if (element.count > header.body.size() / row + 1) {
      Fail(source, "is cut short: the header promises " + std::to_string(element.count) + " x '" +
                       element.name + "'");
    }
    if (element.name == "vertex") return element;
    std::string_view line;
    LineReader lines(header.body);
    for (std::size_t i = 0; ascii && i < element.count && lines.Next(line); ++i) {
    }
    header.body_line += lines.number();
    header.body = ascii ? lines.rest()
                        : header.body.substr(std::min(header.body.size(), element.count * row));
  }
  Fail(source, "PLY has no element 'vertex'");
}

std::string PlyHeaderText(std::size_t count) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(count) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\n"
         "end_header\n";
}

}  // namespace

PointCloud ParsePly(std::string_view bytes, const std::string& source) {
  PlyHeader header = ReadPlyHeader(bytes, source);
  if (header.format != "ascii" && header.format != "binary_little_endian" &&
      header.format != "binary_big_endian") {
    Fail(source, "PLY format must be ascii, binary_little_endian or binary_big_endian");
  }
  const PlyElement& vertices = SkipToVertices(header, source);
  PointCloud cloud;
  if (header.format == "ascii") {
    DecodeAscii(header.body, vertices.count, vertices.fields, header.body_line, source, cloud);
    return cloud;
  }
  if (vertices.count > header.body.size() / RowBytes(vertices.fields)) {
    Fail(source, "is cut short: not all of its vertices are there");
  }
  DecodeBinary(header.body, vertices.count, vertices.fields, PointLayout::kRows, source, cloud);
  return cloud;
}

void WritePly(const std::string& path, const std::vector<Point>& points) {
  std::string body(points.size() * 4 * sizeof(float), '\0');
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float values[4] = {points[i].x, points[i].y, points[i].z, points[i].intensity};
    std::memcpy(&body[i * sizeof(values)], values, sizeof(values));
  }
  WriteFile(path, {PlyHeaderText(points.size()), body});
}

}  // namespace hv
