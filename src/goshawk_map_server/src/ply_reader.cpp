// The PLY format (Turk, "The PLY Polygon File Format", 1994).

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

#include "readers.hpp"
#include "text.hpp"

namespace goshawk::map_server {
namespace {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };
enum class Encoding { ascii, little, big };

struct Property {
  std::string_view name;
  Type type = Type::f32;
  std::optional<Type> list_size;  // a list: its length comes first
};

struct Element {
  std::string_view name;
  std::uint64_t rows = 0;
  std::vector<Property> properties;
};

struct PlyHeader {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::string_view data;
};

std::optional<Type> type_of(std::string_view name) {
  if (name == "char" || name == "int8") return Type::i8;
  if (name == "uchar" || name == "uint8") return Type::u8;
  if (name == "short" || name == "int16") return Type::i16;
  if (name == "ushort" || name == "uint16") return Type::u16;
  if (name == "int" || name == "int32") return Type::i32;
  if (name == "uint" || name == "uint32") return Type::u32;
  if (name == "float" || name == "float32") return Type::f32;
  if (name == "double" || name == "float64") return Type::f64;
  return {};
}

std::size_t bytes_of(Type type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[std::size_t(type)];
}

bool is_integer(Type type) {
  return type != Type::f32 && type != Type::f64;
}

std::optional<Property> read_property(const std::vector<std::string_view>& words) {
  Property property;
  if (words.size() == 5 && words[1] == "list") {
    property.list_size = type_of(words[2]);
    if (!property.list_size || !is_integer(*property.list_size)) return {};
  } else if (words.size() != 3) {
    return {};
  }
  const auto type = type_of(words[words.size() - 2]);
  if (!type) return {};
  property.type = *type;
  property.name = words.back();
  return property;
}

Result<PlyHeader> read_ply_header(std::string_view bytes) {
  TextReader reader(bytes);
  if (reader.line() != "ply") return malformed("the first line is not 'ply': not a PLY file");
  PlyHeader header;
  bool has_format = false;
  while (!reader.done()) {
    const auto words = split(reader.line());
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") {
      header.data = reader.rest();
      if (!has_format) return malformed("the header has no format line");
      return header;
    }
    if (words[0] == "format" && words.size() >= 2) {
      has_format = true;
      if (words[1] == "ascii")
        header.encoding = Encoding::ascii;
      else if (words[1] == "binary_little_endian")
        header.encoding = Encoding::little;
      else if (words[1] == "binary_big_endian")
        header.encoding = Encoding::big;
      else
        return malformed("the format must be ascii, binary_little_endian or binary_big_endian");
    } else if (words[0] == "element" && words.size() == 3) {
      const auto rows = parse<std::uint64_t>(words[2]);
      if (!rows) return malformed(fmt::format("the element '{}' has no number", words[1]));
      header.elements.push_back({words[1], *rows, {}});
    } else if (words[0] == "property" && !header.elements.empty()) {
      const auto property = read_property(words);
      if (!property) return malformed("the header has a property of an unknown type");
      header.elements.back().properties.push_back(*property);
    } else {
      return malformed(fmt::format("the header has a line '{}', which no PLY file has",
                                   words[0].substr(0, 20)));
    }
  }
  return malformed("the header does not end: the file is truncated");
}

// Takes values off the front of the data, in any of the three encodings.
class Values {
 public:
  Values(std::string_view data, Encoding encoding)
      : text_(data), bytes_(data), encoding_(encoding) {}

  bool is_text() const { return encoding_ == Encoding::ascii; }

  std::optional<double> next(Type type) {
    return encoding_ == Encoding::ascii ? parse<double>(text_.word()) : binary(type);
  }

 private:
  std::optional<double> binary(Type type) {
    const std::size_t size = bytes_of(type);
    if (bytes_.size() < size) return {};
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t at = encoding_ == Encoding::big ? i : size - 1 - i;
      bits = bits << 8 | std::uint8_t(bytes_[at]);
    }
    bytes_.remove_prefix(size);
    switch (type) {
      case Type::i8:
        return double(std::int8_t(bits));
      case Type::i16:
        return double(std::int16_t(bits));
      case Type::i32:
        return double(std::int32_t(bits));
      case Type::f32:
        return double(std::bit_cast<float>(std::uint32_t(bits)));
      case Type::f64:
        return std::bit_cast<double>(bits);
      default:
        return double(bits);
    }
  }

  TextReader text_;
  std::string_view bytes_;
  Encoding encoding_;
};

// Takes one row off: take(property, value) for each value, those of lists one after another. Each
// takes at least a byte, so the file's length bounds the work whatever a list claims.
template <typename Take>
bool read_row(Values& values, const Element& element, const Take& take) {
  for (const Property& property : element.properties) {
    double length = 1.0;
    if (property.list_size) {
      const auto claimed = values.next(*property.list_size);
      if (!claimed || !(*claimed >= 0.0)) return false;
      length = *claimed;
    }
    for (double i = 0.0; i < length; i += 1.0) {
      const auto value = values.next(property.type);
      if (!value) return false;
      take(property, *value);
    }
  }
  return true;
}

int axis_of(const Property& property) {
  if (property.list_size || property.name.size() != 1) return -1;
  const auto axis = std::string_view("xyz").find(property.name[0]);
  return axis == std::string_view::npos ? -1 : int(axis);
}

bool lists_vertices(const Property& property) {
  return property.list_size &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// What the elements say, one after another; vertices may come last.
class CloudBuilder {
 public:
  Status read(const Element& element, Values& values);
  Result<Cloud> finish() &&;

 private:
  Status read_vertices(const Element& element, Values& values);
  Status read_rows(const Element& element, Values& values);
  void add(const Element& element);
  void add_triangle(double a, double b, double c) { corners_.push_back({a, b, c}); }

  Cloud cloud_;
  bool has_vertices_ = false;
  std::vector<double> row_;                     // numbers of vertices in one row
  std::vector<std::array<double, 3>> corners_;  // as the file gives them
};

Error cut_off(const Element& element, std::uint64_t row) {
  return malformed(fmt::format(
      "the header promises {} rows of '{}', but row {} is cut off or not a number: the file is "
      "truncated or damaged",
      element.rows, element.name, row + 1));
}

Status CloudBuilder::read(const Element& element, Values& values) {
  if (element.name == "vertex") return read_vertices(element, values);
  const bool flat = element.name == "face" || element.name == "tristrips";
  if (flat && element.rows > 0 && std::ranges::none_of(element.properties, lists_vertices)) {
    return malformed(fmt::format("the element '{}' has no list vertex_indices: its surfaces cannot "
                                 "be read",
                                 element.name));
  }
  return read_rows(element, values);
}

Status CloudBuilder::read_vertices(const Element& element, Values& values) {
  int found = 0;
  for (const Property& property : element.properties) {
    if (axis_of(property) < 0) continue;
    ++found;
    cloud_.single_precision |= property.type == Type::f32 && !values.is_text();
  }
  if (found != 3) return malformed("the element vertex lacks the properties x, y, z");
  has_vertices_ = true;
  for (std::uint64_t row = 0; row < element.rows; ++row) {
    Vec3 p = Vec3::Zero();
    const bool whole = read_row(values, element, [&](const Property& property, double value) {
      if (const int axis = axis_of(property); axis >= 0) p[axis] = value;
    });
    if (!whole) return cut_off(element, row);
    cloud_.points.push_back(p);
  }
  return success();
}

Status CloudBuilder::read_rows(const Element& element, Values& values) {
  if (element.properties.empty()) return success();
  const bool edges = element.name == "edge";
  for (std::uint64_t row = 0; row < element.rows; ++row) {
    row_.clear();
    const bool whole = read_row(values, element, [&](const Property& property, double value) {
      const bool end = edges && (property.name == "vertex1" || property.name == "vertex2");
      if (end || lists_vertices(property)) row_.push_back(value);
    });
    if (!whole) return cut_off(element, row);
    add(element);
  }
  return success();
}

// A polygon becomes a fan, which covers it even if it is not convex; an edge a triangle without
// area. A strip's -1 begins a new one.
void CloudBuilder::add(const Element& element) {
  if (element.name == "tristrips") {
    for (std::size_t i = 2; i < row_.size(); ++i) {
      if (row_[i - 2] >= 0.0 && row_[i - 1] >= 0.0 && row_[i] >= 0.0) {
        add_triangle(row_[i - 2], row_[i - 1], row_[i]);
      }
    }
    return;
  }
  if (row_.size() == 2) add_triangle(row_[0], row_[1], row_[1]);
  for (std::size_t i = 2; i < row_.size(); ++i) add_triangle(row_[0], row_[i - 1], row_[i]);
}

Result<Cloud> CloudBuilder::finish() && {
  if (!has_vertices_) return malformed("it has no element 'vertex'");
  const double count = double(cloud_.points.size());
  cloud_.triangles.reserve(corners_.size());
  for (const auto& corners : corners_) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(corners[k] >= 0.0 && corners[k] < count)) {
        return malformed(fmt::format("a face names the vertex {:g} of {}: the file is damaged",
                                     corners[k], cloud_.points.size()));
      }
      triangle[k] = std::uint32_t(corners[k]);
      if (!is_finite(cloud_.points[triangle[k]])) {
        return malformed(fmt::format("a face has the vertex {}, which is not finite: repair the "
                                     "mesh",
                                     triangle[k]));
      }
    }
    cloud_.triangles.push_back(triangle);
  }
  return std::move(cloud_);
}

}  // namespace

Result<Cloud> read_ply(std::string_view bytes) {
  const auto header = read_ply_header(bytes);
  if (!header) return header.error();
  Values values(header->data, header->encoding);
  CloudBuilder builder;
  for (const Element& element : header->elements) {
    if (auto status = builder.read(element, values); !status) return status.error();
  }
  return std::move(builder).finish();
}

}  // namespace goshawk::map_server
