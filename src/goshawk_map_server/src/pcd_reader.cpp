// The PCD format of the Point Cloud Library, version 0.7 (pointclouds.org, "The PCD file format").

#include <fmt/format.h>
#include <liblzf/lzf.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "readers.hpp"
#include "text.hpp"

namespace goshawk::map_server {
namespace {

struct Field {
  std::size_t offset = 0;  // [bytes] within a point
  std::size_t column = 0;  // [words] within a line of text
  std::size_t size = 4;    // [bytes] 1, 2, 4 or 8
  char type = 'F';         // F: 4 or 8 bytes, I or U
};

struct PcdHeader {
  std::array<Field, 3> xyz;
  std::size_t stride = 0;   // [bytes] of a point
  std::size_t columns = 0;  // [words] of a point
  std::uint64_t points = 0;
  std::string_view encoding;
  std::string_view data;
  std::optional<Viewpoint> viewpoint;
};

// The header's lines as they stand; each is present once at most.
struct Lines {
  std::vector<std::string_view> fields, size, type, count, width, height, points, viewpoint;
};

// @return the line's place, or null for a key that no PCD file has. COLUMNS was FIELDS before 0.6.
std::vector<std::string_view>* place_of(std::string_view key, Lines& lines) {
  if (key == "FIELDS" || key == "COLUMNS") return &lines.fields;
  if (key == "SIZE") return &lines.size;
  if (key == "TYPE") return &lines.type;
  if (key == "COUNT") return &lines.count;
  if (key == "WIDTH") return &lines.width;
  if (key == "HEIGHT") return &lines.height;
  if (key == "POINTS") return &lines.points;
  if (key == "VIEWPOINT") return &lines.viewpoint;
  return nullptr;
}

bool is_number(const Field& field) {
  const bool float_size = field.size == 4 || field.size == 8;
  return field.type == 'F' ? float_size : field.type == 'I' || field.type == 'U';
}

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
      return malformed(fmt::format("the field '{}' has an invalid SIZE or COUNT", lines.fields[i]));
    }
    constexpr std::string_view names = "xyz";
    const std::size_t axis =
        lines.fields[i].size() == 1 ? names.find(lines.fields[i][0]) : std::string_view::npos;
    if (axis != std::string_view::npos) {
      Field& field = header.xyz[axis];
      const char type = lines.type[i].size() == 1 ? lines.type[i][0] : '?';
      field = {header.stride, header.columns, *size, type};
      if (!is_number(field) || *count != 1) {
        return malformed(fmt::format("the field '{}' must be one number: TYPE F with SIZE 4 or 8, "
                                     "I or U, and COUNT 1",
                                     lines.fields[i]));
      }
      found[axis] = true;
    }
    header.stride += std::size_t{*size} * *count;
    header.columns += *count;
  }
  if (!found[0] || !found[1] || !found[2]) return malformed("FIELDS lacks x, y or z");
  return header;
}

Result<std::uint64_t> point_count(const Lines& lines) {
  if (lines.points.size() == 1) {
    if (const auto points = parse<std::uint64_t>(lines.points[0])) return *points;
    return malformed("POINTS is not a number");
  }
  const auto width = lines.width.size() == 1 ? parse<std::uint32_t>(lines.width[0]) : std::nullopt;
  const auto height =
      lines.height.size() == 1 ? parse<std::uint32_t>(lines.height[0]) : std::nullopt;
  if (!width || !height) return malformed("the header has neither POINTS nor WIDTH and HEIGHT");
  return std::uint64_t{*width} * *height;
}

// VIEWPOINT tx ty tz qw qx qy qz
Result<std::optional<Viewpoint>> viewpoint_of(const Lines& lines) {
  if (lines.viewpoint.empty()) return std::optional<Viewpoint>();
  std::array<double, 7> v{};
  bool numbers = lines.viewpoint.size() == v.size();
  for (std::size_t i = 0; numbers && i < v.size(); ++i) {
    const auto value = parse<double>(lines.viewpoint[i]);
    numbers = value && std::isfinite(*value);
    v[i] = value.value_or(0.0);
  }
  const Eigen::Quaternion<double, Eigen::DontAlign> q(v[3], v[4], v[5], v[6]);
  if (!numbers || !(q.norm() > 1e-6)) {
    return malformed("VIEWPOINT must be seven numbers: a position and a quaternion (w x y z)");
  }
  const Viewpoint viewpoint{{v[0], v[1], v[2]}, q.normalized()};
  const bool turned = viewpoint.orientation.vec().norm() > 1e-9;
  if (viewpoint.position.isZero(0.0) && !turned) return std::optional<Viewpoint>();
  return std::optional(viewpoint);
}

Result<PcdHeader> finish_header(const Lines& lines, std::string_view encoding,
                                std::string_view data) {
  auto header = layout(lines);
  if (!header) return header;
  const auto points = point_count(lines);
  if (!points) return points.error();
  auto viewpoint = viewpoint_of(lines);
  if (!viewpoint) return viewpoint.error();
  header->points = *points;
  header->viewpoint = *viewpoint;
  header->encoding = encoding;
  header->data = data;
  return header;
}

Result<PcdHeader> read_pcd_header(std::string_view bytes) {
  TextReader reader(bytes);
  Lines lines;
  while (!reader.done()) {
    auto words = split(reader.line());
    if (words.empty() || words[0].front() == '#') continue;
    const std::string_view key = words[0];
    words.erase(words.begin());
    if (auto* place = place_of(key, lines)) {
      *place = words;
    } else if (key == "DATA" && words.size() == 1) {
      return finish_header(lines, words[0], reader.rest());
    } else if (key != "VERSION") {
      return malformed(
          fmt::format("the header has a line '{}', which no PCD file has", key.substr(0, 20)));
    }
  }
  return malformed("the header has no DATA line: the file is truncated, or not a PCD file");
}

Error too_short(const PcdHeader& header, const std::string& what) {
  return malformed(fmt::format("the header promises {} points, but {}: the file is truncated",
                               header.points, what));
}

template <typename T>
double load_as(const char* at) {
  T value{};
  std::memcpy(&value, at, sizeof value);
  return double(value);
}

double load(const char* at, const Field& field) {
  if (field.type == 'F') return field.size == 8 ? load_as<double>(at) : load_as<float>(at);
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? load_as<std::int8_t>(at) : load_as<std::uint8_t>(at);
    case 2:
      return is_signed ? load_as<std::int16_t>(at) : load_as<std::uint16_t>(at);
    case 4:
      return is_signed ? load_as<std::int32_t>(at) : load_as<std::uint32_t>(at);
    default:
      return is_signed ? load_as<std::int64_t>(at) : load_as<std::uint64_t>(at);
  }
}

Error not_a_number(std::size_t point, std::string_view word) {
  const char* hint = word.find(',') == std::string_view::npos
                         ? ""
                         : ": write a decimal point instead of the comma";
  return malformed(
      fmt::format("point {} has the coordinate '{}'{}", point, word.substr(0, 20), hint));
}

Result<Points> read_ascii(const PcdHeader& header) {
  // A line takes two bytes a column: a claim that cannot be true is not even begun.
  if (header.points > header.data.size() / (2 * header.columns) + 1) {
    return too_short(header, "the data are too short for them");
  }
  Points points;
  points.reserve(header.points);
  TextReader reader(header.data);
  while (points.size() < header.points) {
    if (reader.done()) {
      return too_short(header, fmt::format("there are {}", points.size()));
    }
    const auto words = split(reader.line());
    if (words.empty()) continue;
    if (words.size() < header.columns) {
      return malformed(fmt::format("point {} has {} values instead of {}", points.size() + 1,
                                   words.size(), header.columns));
    }
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = words[header.xyz[std::size_t(axis)].column];
      const auto value = parse<double>(word);
      if (!value) return not_a_number(points.size() + 1, word);
      p[axis] = *value;
    }
    points.push_back(p);
  }
  return points;
}

Result<Points> read_binary(const PcdHeader& header) {
  if (header.points > header.data.size() / header.stride) {
    return too_short(header,
                     fmt::format("there are bytes for {}", header.data.size() / header.stride));
  }
  Points points(header.points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const Field& field = header.xyz[std::size_t(axis)];
      points[i][axis] = load(header.data.data() + i * header.stride + field.offset, field);
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
    return malformed(fmt::format(
        "the compressed data do not hold the {} points that the header promises", header.points));
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
          load(plain.data() + field.offset * header.points + i * field.size, field);
    }
  }
  return points;
}

Result<Points> read_points(const PcdHeader& header) {
  if (header.encoding == "ascii") return read_ascii(header);
  if (header.encoding == "binary") return read_binary(header);
  if (header.encoding == "binary_compressed") return read_compressed(header);
  return malformed(fmt::format("DATA is '{}': it must be ascii, binary or binary_compressed",
                               header.encoding.substr(0, 20)));
}

}  // namespace

Result<Cloud> read_pcd(std::string_view bytes) {
  const auto header = read_pcd_header(bytes);
  if (!header) return header.error();
  auto points = read_points(*header);
  if (!points) return points.error();
  Cloud cloud;
  cloud.points = *std::move(points);
  cloud.viewpoint = header->viewpoint;
  for (const Field& field : header->xyz) {
    cloud.single_precision |= field.type == 'F' && field.size == 4 && header->encoding != "ascii";
  }
  return cloud;
}

}  // namespace goshawk::map_server
