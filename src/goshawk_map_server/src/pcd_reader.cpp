// The PCD format of the Point Cloud Library, version 0.7 (pointclouds.org, "The PCD file format").

#include <liblzf/lzf.h>

#include <array>
#include <cstdint>
#include <cstring>

#include "readers.hpp"
#include "text.hpp"

namespace goshawk::map_server {
namespace {

struct Field {
  std::size_t offset = 0;  // [bytes] within a point
  std::size_t column = 0;  // [words] within a line of text
  std::size_t size = 4;    // [bytes] 4 or 8
};

struct PcdHeader {
  std::array<Field, 3> xyz;
  std::size_t stride = 0;   // [bytes] of a point
  std::size_t columns = 0;  // [words] of a point
  std::uint64_t points = 0;
  std::string_view encoding;
  std::string_view data;
};

// The header's lines as they stand; each is present once at most.
struct Lines {
  std::vector<std::string_view> fields, size, type, count, width, height, points;
};

Result<PcdHeader> layout(const Lines& lines) {
  const std::size_t n = lines.fields.size();
  if (n == 0 || lines.size.size() != n || lines.type.size() != n ||
      (!lines.count.empty() && lines.count.size() != n)) {
    return malformed("FIELDS, SIZE, TYPE and COUNT of the header do not agree");
  }
  PcdHeader header;
  std::array<bool, 3> found{};
  for (std::size_t i = 0; i < n; ++i) {
    const auto size = parse<std::uint32_t>(lines.size[i]);
    const auto count = lines.count.empty() ? 1U : parse<std::uint32_t>(lines.count[i]);
    const bool sizes_ok = size && (*size == 1 || *size == 2 || *size == 4 || *size == 8);
    if (!sizes_ok || !count || *count > 1'000'000) {
      return malformed("SIZE or COUNT of the field '" + std::string(lines.fields[i]) +
                       "' is no number that can be");
    }
    constexpr std::string_view names = "xyz";
    const std::size_t axis =
        lines.fields[i].size() == 1 ? names.find(lines.fields[i][0]) : std::string_view::npos;
    if (axis != std::string_view::npos) {
      if (lines.type[i] != "F" || *size < 4 || *count != 1) {
        return malformed("the field '" + std::string(lines.fields[i]) +
                         "' must be one float of 4 or 8 bytes");
      }
      header.xyz[axis] = {header.stride, header.columns, *size};
      found[axis] = true;
    }
    header.stride += std::size_t{*size} * *count;
    header.columns += *count;
  }
  if (!found[0] || !found[1] || !found[2]) return malformed("the fields x, y, z are not all there");
  return header;
}

Result<std::uint64_t> point_count(const Lines& lines) {
  if (lines.points.size() == 1) {
    if (const auto points = parse<std::uint64_t>(lines.points[0])) return *points;
    return malformed("POINTS is no number");
  }
  const auto width = lines.width.size() == 1 ? parse<std::uint32_t>(lines.width[0]) : std::nullopt;
  const auto height =
      lines.height.size() == 1 ? parse<std::uint32_t>(lines.height[0]) : std::nullopt;
  if (!width || !height) return malformed("the header tells no number of points");
  return std::uint64_t{*width} * *height;
}

Result<PcdHeader> read_pcd_header(std::string_view bytes) {
  TextReader reader(bytes);
  Lines lines;
  while (!reader.done()) {
    auto words = split(reader.line());
    if (words.empty() || words[0].front() == '#') continue;
    const std::string_view key = words[0];
    words.erase(words.begin());
    if (key == "FIELDS")
      lines.fields = words;
    else if (key == "SIZE")
      lines.size = words;
    else if (key == "TYPE")
      lines.type = words;
    else if (key == "COUNT")
      lines.count = words;
    else if (key == "WIDTH")
      lines.width = words;
    else if (key == "HEIGHT")
      lines.height = words;
    else if (key == "POINTS")
      lines.points = words;
    else if (key == "DATA" && words.size() == 1) {
      auto header = layout(lines);
      if (!header) return header;
      const auto points = point_count(lines);
      if (!points) return points.error();
      header->points = *points;
      header->encoding = words[0];
      header->data = reader.rest();
      return header;
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      return malformed("the header has the line '" + std::string(key.substr(0, 20)) +
                       "', which no PCD file has");
    }
  }
  return malformed("the header has no DATA line: it is truncated, or no PCD file");
}

Error too_short(const PcdHeader& header, const std::string& what) {
  return malformed("the header promises " + std::to_string(header.points) + " points, but " + what +
                   ": the file is truncated");
}

double load(const char* at, std::size_t size) {
  if (size == 8) {
    double value = 0.0;
    std::memcpy(&value, at, sizeof value);
    return value;
  }
  float value = 0.0F;
  std::memcpy(&value, at, sizeof value);
  return double(value);
}

Result<Points> read_ascii(const PcdHeader& header) {
  // A line takes two bytes a column: a claim that cannot be true is not even begun.
  if (header.points > header.data.size() / (2 * header.columns) + 1) {
    return too_short(header, "there is no room for them");
  }
  Points points;
  points.reserve(header.points);
  TextReader reader(header.data);
  while (points.size() < header.points) {
    if (reader.done()) {
      return too_short(header, "there are " + std::to_string(points.size()));
    }
    const auto words = split(reader.line());
    if (words.empty()) continue;
    if (words.size() < header.columns) {
      return malformed("point " + std::to_string(points.size() + 1) + " has " +
                       std::to_string(words.size()) + " values instead of " +
                       std::to_string(header.columns));
    }
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = parse<double>(words[header.xyz[std::size_t(axis)].column]);
      if (!value) {
        return malformed("point " + std::to_string(points.size() + 1) + " is no number");
      }
      p[axis] = *value;
    }
    points.push_back(p);
  }
  return points;
}

Result<Points> read_binary(const PcdHeader& header) {
  if (header.points > header.data.size() / header.stride) {
    return too_short(header,
                     "there are bytes for " + std::to_string(header.data.size() / header.stride));
  }
  Points points(header.points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const Field& field = header.xyz[std::size_t(axis)];
      points[i][axis] = load(header.data.data() + i * header.stride + field.offset, field.size);
    }
  }
  return points;
}

// Two sizes, then LZF; inside, all values of the first field come first, then of the second.
Result<Points> read_compressed(const PcdHeader& header) {
  std::uint32_t sizes[2] = {0, 0};
  if (header.data.size() < sizeof sizes) return too_short(header, "the data end at once");
  std::memcpy(sizes, header.data.data(), sizeof sizes);
  const std::string_view packed = header.data.substr(sizeof sizes);
  if (sizes[0] > packed.size()) return too_short(header, "the compressed data are cut off");
  if (header.points > sizes[1] / header.stride || sizes[1] != header.points * header.stride) {
    return malformed("the compressed data do not hold the " + std::to_string(header.points) +
                     " points that the header promises");
  }
  // LZF never packs more than 264 bytes into three: a greater claim is not given memory.
  if (sizes[1] / 88 > sizes[0]) return malformed("the compressed data claim an impossible size");
  std::string plain(sizes[1], '\0');
  if (sizes[1] > 0 && lzf_decompress(packed.data(), sizes[0], plain.data(), sizes[1]) != sizes[1]) {
    return malformed("the compressed data are damaged");
  }
  Points points(header.points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const Field& field = header.xyz[std::size_t(axis)];
      points[i][axis] =
          load(plain.data() + field.offset * header.points + i * field.size, field.size);
    }
  }
  return points;
}

}  // namespace

Result<Points> read_pcd(std::string_view bytes) {
  const auto header = read_pcd_header(bytes);
  if (!header) return header.error();
  if (header->encoding == "ascii") return read_ascii(*header);
  if (header->encoding == "binary") return read_binary(*header);
  if (header->encoding == "binary_compressed") return read_compressed(*header);
  return malformed("DATA is '" + std::string(header->encoding.substr(0, 20)) +
                   "': only ascii, binary and binary_compressed are known");
}

}  // namespace goshawk::map_server
